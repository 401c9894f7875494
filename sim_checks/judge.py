"""Validate many files: one warm child for what needs no simulator, and one for each simulator."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from .checks.disagreement import disagreements
from .checks.result import CheckResult
from .config import CheckConfig
from .description import Description, DescriptionError
from .processes.isolation import Failure, Outcome, WarmChild, preload
from .read.gather import Gathered, gather
from .read.native import ask_of
from .read.roots import OWN_PACKAGE, ReadOptions
from .read.usd.as_urdf import write_as_urdf
from .read.usd.layers import is_usd
from .report import KILLED, OUT_OF_TIME, Finding, Report, Severity

DEFAULT_CONFIG = CheckConfig()
#: Imported once for all children that a validator asks.
COMMON_MODULES = (
    "asset_factory.sim_checks.checks.catalog",
    "asset_factory.sim_checks.simulators.observe",
)
#: Codes of simulators that were asked and are no witnesses.
ABSENT = frozenset({"format_not_loaded", "simulator_missing"})


@dataclass(frozen=True)
class Examination(CheckResult):
    """What needs no simulator: of reading and of all checks, numbers by check.

    Attributes:
        description: the file as read; ``None`` if it cannot be.
    """

    description: Description | None = None


class Judge:
    """Validates URDF, MJCF and USD files one after another; close it, or use it by ``with``.

    A report is the same whatever was validated before, in whatever order, and however many
    simulators ran at once.
    """

    def __init__(self, config: CheckConfig = DEFAULT_CONFIG, workers: int = 1) -> None:
        """Keep the settings; no process starts before it is needed.

        Args:
            config: every threshold.
            workers: simulators that may run at once.
        """
        self._config = config
        self._workers = workers
        self._children: dict[str, WarmChild] = {}
        preload(COMMON_MODULES)

    def __enter__(self) -> Judge:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """End every child."""
        while self._children:
            self._children.popitem()[1].close()

    def examine(self, path: Path) -> Examination:
        """Read a file and run the static checks on it.

        Native code runs in a killable child; where that dies, the lint alone is tried again, so
        that its word is not lost.
        """
        child = self._child("static")
        limits = self._config.child.limits
        outcome = child.call(examine_here, path, self._config, limits=limits)
        if outcome.value is not None:
            return outcome.value
        failure = _failure(outcome, path)
        second = None
        if not isinstance(outcome.error, DescriptionError):
            second = child.call(examine_here, path, self._config, limits=limits, native=False).value
        if second is None:
            return Examination((failure,))
        return replace(second, findings=(failure, *second.findings))

    def check(
        self,
        path: Path,
        simulators: Sequence[str] = ("sapien",),
        examined: Examination | None = None,
        options: ReadOptions = OWN_PACKAGE,
    ) -> Report:
        """Validate one file.

        Args:
            path: the file; its meshes lie in its folder, its package or a root.
            simulators: which engines to ask, by name, in this order; none for the static checks
                alone.
            examined: of this same, unchanged file, where :meth:`examine` has been asked before.
            options: what may be read beyond the file's folder and its package.

        Returns:
            Findings in a fixed order: reading, static checks, then simulator by simulator. The same
            file, settings and library versions give the same report.

        Raises:
            ValueError: for a simulator that does not exist, with those that do.
        """
        from .simulators.catalog import simulator

        for name in simulators:
            simulator(name)
        path = Path(path)
        if examined is not None:
            return self._reported(path.name, examined, simulators)
        with TemporaryDirectory() as folder:
            gathered = self._gathered(path, Path(folder), options)
            if isinstance(gathered, Finding):
                return Report(path.name, () if is_usd(path) else tuple(simulators), (gathered,))
            report = self._reported(path.name, self.examine(gathered.path), simulators)
        return replace(report, findings=(*gathered.findings, *report.findings))

    def _gathered(self, path: Path, folder: Path, options: ReadOptions) -> Gathered | Finding:
        """Return what engines can be asked of a file, see :func:`readable`, or why nothing."""
        limits = self._config.child.limits
        child = self._child("static")
        if is_usd(path):
            try:
                return ask_of(child, path.name, readable, path, folder, options, limits=limits)
            except (DescriptionError, TimeoutError, ChildProcessError) as error:
                return _unanswered(str(error), error)
        outcome = child.call(readable, path, folder, options, limits=limits)
        return _failure(outcome, path) if outcome.value is None else outcome.value

    def _reported(self, name: str, examined: Examination, simulators: Sequence[str]) -> Report:
        findings = list(examined.findings)
        measurements = dict(examined.measurements)
        if examined.description is not None:
            results = self._ask(examined.description, simulators)
            for engine, result in zip(simulators, results, strict=True):
                findings += result.findings
                measurements[engine] = dict(result.measurements)
            findings += _unasked(examined.description, simulators)
        differences = disagreements(findings, measurements, simulators)
        absent = {finding.simulator for finding in findings if finding.code in ABSENT}
        took_part = tuple(engine for engine in simulators if engine not in absent)
        return Report(name, took_part, tuple(findings), measurements, differences)

    def _ask(self, description: Description, simulators: Sequence[str]) -> Iterator[CheckResult]:
        from .checks.in_simulator import judge_in_simulator

        def ask(name: str, child: WarmChild) -> CheckResult:
            return judge_in_simulator(description, name, self._config, child)

        children = [self._child(name) for name in simulators]
        if self._workers == 1 or len(children) < 2:
            return map(ask, simulators, children)
        pool = ThreadPoolExecutor(min(self._workers, len(children)), thread_name_prefix="judge")
        try:
            return iter(list(pool.map(ask, simulators, children)))
        finally:
            # Someone who interrupts does not wait for an engine to finish.
            pool.shutdown(wait=False, cancel_futures=True)

    def _child(self, name: str) -> WarmChild:
        limits = self._config.child
        return self._children.setdefault(name, WarmChild(limits.calls, limits.resident_bytes))


def run_checks(
    description: Path,
    simulators: Sequence[str] = ("sapien",),
    config: CheckConfig = DEFAULT_CONFIG,
    options: ReadOptions = OWN_PACKAGE,
) -> Report:
    """Validate one URDF, MJCF or USD file from anyone: one call of :meth:`Judge.check`.

    Native code runs in killable children; whatever the file does to them becomes a finding.

    Args:
        description: the file; its meshes lie in its folder, its package or a root.
        simulators: which engines to ask, by name, in this order; none for the static checks alone.
        config: every threshold.
        options: what may be read beyond the file's folder and its package.

    Raises:
        ValueError: for a simulator that does not exist, with those that do.
    """
    with Judge(config) as judge:
        return judge.check(description, simulators, options=options)


def readable(path: Path, folder: Path, options: ReadOptions) -> Gathered:
    """Return what engines can be asked of a file: itself, or what says the same in an empty folder.

    Raises:
        DescriptionError: it cannot be read, or refers to what may not be.
    """
    if not is_usd(path):
        return gather(path, folder, options)
    words = f"{path.name} was validated as the URDF that says the same: no engine here reads USD"
    told = Finding("read_as_urdf", Severity.NOTE, words)
    return Gathered(write_as_urdf(path, folder), findings=(told,))


def examine_here(path: Path, config: CheckConfig, *, native: bool = True) -> Examination:
    """Read a file and run the static checks on it in this process; native code only if allowed.

    Raises:
        DescriptionError: if it cannot be read.
    """
    from .checks.catalog import CHECKS
    from .checks.extent import oversized
    from .read.read import read_here

    description = read_here(path)
    if (too_large := oversized(description, config.work)) is not None:
        return Examination((too_large,))
    asked = (check for check in CHECKS if native or not check.native)
    results = {check.name: check.run(description, config) for check in asked}
    findings = tuple(finding for result in results.values() for finding in result.findings)
    measurements = {name: dict(result.measurements) for name, result in results.items()}
    return Examination(findings, measurements, description)


def _unasked(description: Description, simulators: Sequence[str]) -> list[Finding]:
    """Return a file that none of the engines asked for can read has not passed them."""
    from .simulators.catalog import SIMULATORS

    if not simulators or any(description.format in SIMULATORS[name].formats for name in simulators):
        return []
    readers = [name for name, each in SIMULATORS.items() if description.format in each.formats]
    unread = f"none of {', '.join(simulators)} loads {description.format} here"
    message = f"{unread}: nobody drove {description.path.name}; ask {', '.join(readers)}"
    return [Finding("not_simulated", Severity.ERROR, message)]


def _failure(outcome: Outcome[Any], path: Path) -> Finding:
    message = f"the static checks gave no verdict on {path.name}: {outcome.detail}"
    if outcome.failure is Failure.TIMEOUT:
        return _unanswered(message, TimeoutError())
    return _unanswered(message, ChildProcessError() if outcome.killed else outcome.error)


def _unanswered(message: str, error: Exception | None) -> Finding:
    """Tell a refusal, a hang (TimeoutError) and an ended process (ChildProcessError) from a crash.

    Readers in children of their own raise the first three; see :func:`~.read.native.ask_of`.
    """
    if isinstance(error, DescriptionError):
        return Finding(error.code, Severity.ERROR, error.message)
    if isinstance(error, TimeoutError):
        return Finding("check_timeout", Severity.ERROR, message, cause=OUT_OF_TIME)
    cause = KILLED if isinstance(error, ChildProcessError) else None
    return Finding("check_crashed", Severity.ERROR, message, cause=cause)
