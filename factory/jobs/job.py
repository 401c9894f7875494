"""Many inputs into one registry: known ones are answered, new ones built, failures listed."""

from __future__ import annotations

import errno
import os
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, closing, contextmanager, suppress
from dataclasses import dataclass, replace
from functools import cache, partial
from pathlib import Path

from asset_factory.sim_checks import Status
from asset_factory.sim_checks.processes.isolation import Limits, Outcome, preload

from ..articulate.catalog import entry_of
from ..articulate.settings import require_torch
from ..config import BuildConfig
from ..errors import RegistryError
from ..intake.load import DESCRIPTION_SUFFIXES
from ..models.service import Address, ModelService
from ..registry import Entry, Registry
from ..registry.aside import InputNow, keep_current
from ..registry.claims import Claim, claim
from ..registry.logged import Log
from ..registry.product import Product
from ..registry.registration import register, register_failure
from ..registry.result import Result, known_result
from ..registry.verify import verify
from ..report.summary import JobState
from ..runtime.layout import CACHE, CLAIMS
from ..runtime.store import Store
from .budget import ANY, Budget
from .executor import Call, Executor, UnderWay
from .local import LocalExecutor
from .probe import KnownReads, Probe, known_of
from .signals import undisturbed
from .worker import build_here

#: Imported once per job instead of once per child.
COMMON_MODULES = (
    *("scipy.spatial", "trimesh", "manifold3d", "fcl"),
    "asset_factory.factory.jobs.worker",
)
SAPIEN_MODULE = "asset_factory.sim_checks.simulators.warm"
#: How often a job looks whether another one has finished what it waits for [s].
POLL_S = 0.5
#: The place to write, not the input, is at fault.
FULL_OR_CLOSED = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EROFS, errno.EIO})
UNWRITABLE = FULL_OR_CLOSED | {errno.EACCES, errno.EPERM}


def modules_for(config: BuildConfig) -> tuple[str, ...]:
    """Return what every worker needs, and had better import only once."""
    return (*COMMON_MODULES, *((SAPIEN_MODULE,) if "sapien" in config.simulators else ()))


def asks_network(inputs: Sequence[Path], config: BuildConfig) -> bool:
    """Tell whether one of the inputs may be shown to a network: a mesh, not a description."""
    plain = any(path.suffix.lower() not in DESCRIPTION_SUFFIXES for path in inputs)
    return plain and entry_of(config.articulator).asks_network


@dataclass(frozen=True)
class _Begun:
    """An input that a worker has."""

    probe: Probe
    claim: Claim


class Job:
    """One run over some inputs. The same job again builds only missing ones.

    Args:
        inputs: files, as :func:`~..intake.discover.find_inputs` lists them; each once.
        output: the registry's folder; made if it is not there.
        executor: of one on this machine all workers ask one network.

    Attributes:
        left: inputs not done, for want of time or because the limit was reached.
        state: how it ended, so far.

    Raises:
        ConfigError: one of the inputs may be shown to a network, and none can run.
    """

    def __init__(
        self,
        inputs: Sequence[Path],
        output: Path,
        config: BuildConfig,
        executor: Executor,
        budget: Budget | None = None,
    ) -> None:
        if asks_network(inputs, config):
            require_torch()
        self._inputs = inputs
        self._output = output.absolute()
        self._config = config
        self._executor = executor
        self._local = executor if isinstance(executor, LocalExecutor) else None
        self._budget = budget or Budget()
        self._registry = Registry(self._output, create=True)
        self._known_reads = KnownReads(output / CACHE / "inputs", config)
        self._begun: dict[str, _Begun] = {}
        self._aside: list[Probe] = []
        self._meanwhile: list[Result] = []
        self._built: set[str] = set()
        self._damaged: set[str] = set(self._budget.damaged)
        self._sound: set[str] = set()
        self._calls_made = 0
        self._until: float | None = None
        self._winding_up = False
        self.left = 0
        self.state = JobState.FINISHED

    def run(self) -> Iterator[Result]:
        """Run; yield each input's result once, known ones first, the others as they are done.

        Closing the iterator, or an exception, kills running builds; finished ones are registered.

        Raises:
            RegistryError: the registry cannot be written any more.
        """
        with self._writable():
            yield from self._run()

    def wind_up(self) -> None:
        """Begin nothing more; what workers have is finished."""
        self._winding_up = True

    def under_way(self) -> tuple[UnderWay, ...]:
        """Return what workers on this machine are at; from any thread."""
        return () if self._local is None else self._local.under_way()

    def _run(self) -> Iterator[Result]:
        self._until = None if self._budget.max_s is None else time.monotonic() + self._budget.max_s
        waiting = []
        urgent = []
        for probes in self._known_reads.probe_all(self._inputs):
            found = [*zip(probes, known_of(probes, self._registry), strict=True)]
            keep_current(self._registry, [*_known_inputs(found)])
            for probe, entry in found:
                if entry is not None and entry.id in self._budget.damaged:
                    urgent.append(probe)
                elif entry is None or self._wants_again(entry):
                    waiting.append(probe)
                else:
                    yield known_result(str(probe.given), entry)
        if urgent or waiting:
            yield from self._build(urgent + waiting)

    def _wants_again(self, entry: Entry) -> bool:
        """Return whether a known input is built all the same."""
        if self._budget.repair and entry.id not in self._sound and entry.id not in self._damaged:
            problems = verify(self._registry, (entry.id,))
            (self._damaged if problems else self._sound).add(entry.id)
        asked = entry.reason in self._budget.retry or ANY in self._budget.retry
        return (asked and entry.status is not Status.PASSED) or entry.id in self._damaged

    def _build(self, waiting: list[Probe]) -> Iterator[Result]:
        preload(modules_for(self._config))
        config = self._config
        limits = Limits(wall_s=config.asset_wall_s, memory_bytes=config.asset_memory_bytes)
        with ExitStack() as stack:
            stack.callback(self._release_all)
            log = stack.enter_context(closing(Log(self._output)))
            log.begun(len(self._inputs), len(self._inputs) - len(waiting))
            try:
                staging = stack.enter_context(self._registry.staging_folder())
                # Started with the first call: there may be none.
                network = cache(partial(self._network, tuple(waiting), stack))
                while waiting:
                    calls = self._calls(waiting, staging, network)
                    for call, outcome in self._executor.run(build_here, calls, limits):
                        yield from self._ended(call, outcome, log)
                        yield from self._known_meanwhile()
                    yield from self._known_meanwhile()
                    waiting = self._aside
                    self._aside = []
                    if waiting and self._is_over():
                        self.left += len(waiting)
                        break
                    if waiting:
                        time.sleep(POLL_S)
            except BaseException:
                self.state = JobState.INTERRUPTED
                raise
            finally:
                # On a full disk there is a better error under way.
                with suppress(OSError):
                    log.ended(self.state, len(self._built), self.left)
                if self._config.cache_gb > 0.0:
                    Store(self._output / CACHE).trim(keep_bytes=round(1e9 * self._config.cache_gb))

    def _network(self, waiting: Sequence[Probe], stack: ExitStack) -> Address | None:
        """Return one network for all workers, if one of the inputs may ask it."""
        asks = asks_network([probe.source for probe in waiting], self._config)
        if self._local is None or not asks:
            return None
        return stack.enter_context(ModelService(self._config.particulate)).address

    def _calls(
        self, waiting: list[Probe], staging: Path, network: Callable[[], Address | None]
    ) -> Iterator[Call]:
        """Yield what workers shall do, made as they ask for it."""
        for number, seen in enumerate(waiting):
            held = claim(self._output / CLAIMS, seen.claim)
            if held is None:
                self._aside.append(seen)
                continue
            # Somebody else may have built it since this job looked; what this job built it does not
            # build again.
            probe = self._known_reads.renewed(seen)
            (entry,) = known_of((probe,), self._registry)
            fresh = probe.claim not in self._built
            if entry is not None and not (self._wants_again(entry) and fresh):
                held.close()
                self._meanwhile.append(known_result(str(probe.given), entry))
                continue
            if self._is_over():
                held.close()
                self.left += len(waiting) - number + len(self._aside)
                self._aside = []
                return
            self._calls_made += 1
            self._begun[str(probe.source)] = _Begun(probe, held)
            folder = staging / str(self._calls_made)
            until = None if self._until is None else time.time() + self._until - time.monotonic()
            arguments = {
                "source": probe.source,
                "staging": folder,
                "config": self._config,
                "cache": self._output / CACHE,
                "address": network(),
                "engines": 1 if self._local is None else self._local.engines,
            }
            yield Call(str(probe.source), arguments, until, lambda: not self._winding_up)

    def _is_over(self) -> bool:
        if self._budget.limit is not None and self._calls_made >= self._budget.limit:
            self.state = JobState.LIMIT_REACHED
        elif self._until is not None and time.monotonic() > self._until:
            self.state = JobState.OUT_OF_TIME
        elif self._winding_up:
            self.state = JobState.INTERRUPTED
        return self.state != JobState.FINISHED

    def _known_meanwhile(self) -> Iterator[Result]:
        while self._meanwhile:
            yield self._meanwhile.pop(0)

    def _ended(self, call: Call, outcome: Outcome[Product], log: Log) -> Iterator[Result]:
        """Register one call's outcome and give up its claim; yield the result."""
        begun = self._begun.pop(call.name)
        with closing(begun.claim):
            if outcome.failure is None and outcome.value is None:
                late = not self._winding_up
                self.state = JobState.OUT_OF_TIME if late else JobState.INTERRUPTED
                self.left += 1
                return
            if isinstance(outcome.error, OSError) and outcome.error.errno in FULL_OR_CLOSED:
                raise outcome.error
            with undisturbed():
                result = self._registered(begun.probe, outcome)
                self._built.add(begun.probe.claim)
                log.built(result, outcome)
        yield result

    def _registered(self, probe: Probe, outcome: Outcome[Product]) -> Result:
        product = outcome.value
        if product is None:
            made_of = (probe.source, probe.reads)
            result = register_failure(self._registry, *made_of, self._config, outcome)
        else:
            self._known_reads.note(probe.source, product.reads)
            result = register(self._registry, product, outcome.tries)
        return replace(result, input=str(probe.given))

    @contextmanager
    def _writable(self) -> Iterator[None]:
        """Raise RegistryError where a worker, or this process, could not write."""
        try:
            yield
        except OSError as failed:
            if failed.errno not in UNWRITABLE:
                raise
            raise RegistryError(
                f"{failed.filename or self._output}: cannot be written: "
                f"{os.strerror(failed.errno)}; what was finished "
                "is registered, and the same command does the rest once it can"
            ) from failed

    def _release_all(self) -> None:
        while self._begun:
            self._begun.popitem()[1].claim.close()


def _known_inputs(found: Sequence[tuple[Probe, Entry | None]]) -> Iterator[InputNow]:
    """Yield which assets inputs are, of those that have a verdict."""
    for probe, entry in found:
        digest = probe.reads[probe.source.name]
        if entry is not None and digest and entry.status is not Status.UNJUDGED:
            yield InputNow(probe.source, digest, entry.id)
