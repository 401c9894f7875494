"""Calls on this machine: a few warm processes that may die."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import islice
from queue import SimpleQueue
from threading import Event, get_ident
from typing import Any, Generic, TypeVar

from asset_factory.sim_checks.processes.isolation import (
    Failure,
    Limits,
    Outcome,
    WarmChild,
    processors,
)

from .executor import AHEAD, Call, UnderWay

T = TypeVar("T")

#: After so many calls a worker is replaced by a new one: native libraries leak a little with every
#: input.
CALLS = 50
#: A worker that holds more memory than this after a call is replaced at once [bytes].
RESIDENT_BYTES = 2 * 1024**3


@dataclass(frozen=True)
class LocalExecutor:
    """Worker processes on this machine, kept from call to call.

    Attributes:
        workers: calls under way at once.
        retries: further tries of a call that crashed, hung or ran out of memory, each in a new
            process.
        calls: after so many a worker is replaced.
    """

    workers: int
    retries: int = 1
    calls: int = CALLS
    _pools: list[_WorkerPool[Any]] = field(default_factory=list, compare=False, repr=False)

    def under_way(self) -> tuple[UnderWay, ...]:
        """Return the calls that are being made now; from any thread."""
        return tuple(each for pool in self._pools for each in pool.under_way())

    @property
    def engines(self) -> int:
        """Return how many simulators each worker may run at once: what processors are left."""
        return max(1, processors() // self.workers)

    def run(
        self, function: Callable[..., T], calls: Iterable[Call], limits: Limits
    ) -> Iterator[tuple[Call, Outcome[T]]]:
        """Make every call as :class:`~.executor.Executor` promises."""
        pool: _WorkerPool[T] = _WorkerPool(self, function, limits)
        self._pools[:] = [pool]
        waiting = iter(calls)
        under_way = 0
        try:
            while True:
                for call in islice(waiting, AHEAD * self.workers - under_way):
                    pool.ask(call)
                    under_way += 1
                if not under_way:
                    return
                answered = pool.answer()
                under_way -= 1
                yield answered
        finally:
            self._pools.clear()
            pool.dismiss()


class _WorkerPool(Generic[T]):
    """Threads that each look after one warm child."""

    def __init__(self, executor: LocalExecutor, function: Callable[..., T], limits: Limits) -> None:
        self._executor = executor
        self._function = function
        self._limits = limits
        self._threads = ThreadPoolExecutor(executor.workers, "build", self._begin)
        self._done: SimpleQueue[Future[tuple[Call, Outcome[T]]]] = SimpleQueue()
        self._dismissed = Event()
        self._children: dict[int, WarmChild] = {}
        self._making: dict[WarmChild, str] = {}

    def ask(self, call: Call) -> None:
        self._threads.submit(self._answered, call).add_done_callback(self._done.put)

    def answer(self) -> tuple[Call, Outcome[T]]:
        return self._done.get().result()

    def dismiss(self) -> None:
        """End all workers at once; running tasks are lost."""
        self._dismissed.set()
        for child in [*self._children.values()]:
            child.abandon()
        self._threads.shutdown(cancel_futures=True)
        for child in self._children.values():
            child.close()

    def under_way(self) -> Iterator[UnderWay]:
        """Yield the calls that are being made."""
        for child, name in [*self._making.items()]:
            yield UnderWay(name, child.place)

    def _begin(self) -> None:
        """Give a new thread its child."""
        child = WarmChild(self._executor.calls, RESIDENT_BYTES)
        self._children[get_ident()] = child

    def _answered(self, call: Call) -> tuple[Call, Outcome[T]]:
        def wanted() -> bool:
            return call.wanted() and not self._dismissed.is_set()

        child = self._children[get_ident()]
        self._making[child] = call.name
        outcome = tried(
            child,
            partial(self._function, **call.arguments),
            self._limits,
            retries=self._executor.retries,
            until=call.until,
            wanted=wanted,
        )
        del self._making[child]
        return call, outcome


def tried(
    child: WarmChild,
    function: Callable[[], T],
    limits: Limits,
    *,
    retries: int,
    until: float | None,
    wanted: Callable[[], bool] = lambda: True,
) -> Outcome[T]:
    """Make one call in a child, again where that may help; whatever it does, this returns.

    Args:
        child: ended where the call does not end.
        function: with its arguments.
        limits: of each try.
        retries: further tries of what crashed, hung or ran out of memory.
        until: when the last try is ended [s since 1970]; ``None``: by the limits alone.
        wanted: asked before each try.

    Returns:
        The outcome of the last try; neither value nor failure where it was not wanted, or not done
        in time.
    """
    tries = 0
    deaths: tuple[str, ...] = ()
    within = replace(limits, until=math.inf if until is None else until)
    outcome: Outcome[T] = Outcome(None, None, "", "", 0.0)
    while True:
        if time.time() >= within.until or not wanted():
            return outcome
        try:
            outcome = child.call(function, limits=within)
        except Exception as error:  # noqa: BLE001 - no process, no folder, no pickle: this call's failure alone
            detail = f"{type(error).__name__}: {error}"
            return Outcome(None, Failure.RAISED, detail, "", 0.0, error, tries + 1)
        if outcome.failure is Failure.TIMEOUT and time.time() >= within.until:
            return Outcome(None, None, "", "", outcome.seconds)
        tries += outcome.tries
        deaths += outcome.deaths
        outcome = replace(outcome, tries=tries, deaths=deaths)
        # A crash, a hang or a moment without memory may have been bad luck.
        ended = outcome.failure in (Failure.CRASHED, Failure.TIMEOUT)
        if tries > retries or not (ended or isinstance(outcome.error, MemoryError)):
            return outcome
        child.close()
