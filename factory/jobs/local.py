"""Calls on this machine: a few warm processes that may die."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import replace
from functools import partial
from itertools import islice
from queue import SimpleQueue
from threading import Event, get_ident
from typing import TypeVar

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


class LocalExecutor:
    """Worker processes on this machine, kept from call to call; threads each look after one.

    Args:
        workers: calls under way at once.
        retries: further tries of a call that crashed, hung or ran out of memory, each in a new
            process.
        calls: after so many a worker is replaced.
    """

    def __init__(self, workers: int, retries: int = 1, calls: int = CALLS) -> None:
        self.workers = workers
        self._retries = retries
        self._calls = calls
        self._making: dict[WarmChild, str] = {}

    def under_way(self) -> tuple[UnderWay, ...]:
        """Return the calls that are being made now; from any thread."""
        return tuple(UnderWay(name, child.place) for child, name in [*self._making.items()])

    @property
    def engines(self) -> int:
        """Return how many simulators each worker may run at once: what processors are left."""
        return max(1, processors() // self.workers)

    def run(
        self, function: Callable[..., T], calls: Iterable[Call], limits: Limits
    ) -> Iterator[tuple[Call, Outcome[T]]]:
        """Make every call as :class:`~.executor.Executor` promises."""
        children: dict[int, WarmChild] = {}
        done: SimpleQueue[Future[tuple[Call, Outcome[T]]]] = SimpleQueue()
        dismissed = Event()

        def begin() -> None:
            children[get_ident()] = WarmChild(self._calls, RESIDENT_BYTES)

        def answered(call: Call) -> tuple[Call, Outcome[T]]:
            child = children[get_ident()]
            self._making[child] = call.name
            outcome = tried(
                child,
                partial(function, **call.arguments),
                limits,
                retries=self._retries,
                until=call.until,
                wanted=lambda: call.wanted() and not dismissed.is_set(),
            )
            del self._making[child]
            return call, outcome

        threads = ThreadPoolExecutor(self.workers, "build", begin)
        waiting = iter(calls)
        under_way = 0
        try:
            while True:
                for call in islice(waiting, AHEAD * self.workers - under_way):
                    threads.submit(answered, call).add_done_callback(done.put)
                    under_way += 1
                if not under_way:
                    return
                outcome = done.get().result()
                under_way -= 1
                yield outcome
        finally:
            dismissed.set()
            for child in [*children.values()]:
                child.abandon()
            threads.shutdown(cancel_futures=True)
            for child in children.values():
                child.close()


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
