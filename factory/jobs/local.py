"""Calls on this machine: a few warm processes that may die."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from queue import SimpleQueue
from threading import Event, Thread
from typing import Generic, TypeVar

from asset_factory.sim_checks.processes.isolation import (
    Failure,
    Limits,
    Outcome,
    WarmChild,
    processors,
)

from .executor import AHEAD, Call

T = TypeVar("T")


@dataclass(frozen=True)
class LocalExecutor:
    """Worker processes on this machine, kept from call to call.

    Attributes:
        workers: calls under way at once.
        retries: further tries of a call that crashed, hung or ran out of memory, each in a new
            process.
        calls: after so many a worker is replaced by a new one: native libraries leak a little with
            every input.
        resident_bytes: a worker that holds more memory than this after a call is replaced at once
            [bytes].
    """

    workers: int
    retries: int = 1
    calls: int = 50
    resident_bytes: int = 2 * 1024**3

    @property
    def engines(self) -> int:
        """Return how many simulators each worker may run at once: what processors are left."""
        return max(1, processors() // self.workers)

    def run(
        self, function: Callable[..., T], calls: Iterable[Call], limits: Limits
    ) -> Iterator[tuple[Call, Outcome[T]]]:
        """Make every call as :class:`~.executor.Executor` promises."""
        pool: _WorkerPool[T] = _WorkerPool(self, function, limits)
        waiting = iter(calls)
        ends = False
        under_way = 0
        try:
            while True:
                while not ends and under_way < AHEAD * self.workers:
                    call = next(waiting, None)
                    if call is None:
                        ends = True
                    else:
                        pool.ask(call)
                        under_way += 1
                if not under_way:
                    return
                answered = pool.answer()
                under_way -= 1
                yield answered
        finally:
            pool.dismiss()


class _WorkerPool(Generic[T]):
    """Threads that each look after one warm child."""

    def __init__(self, executor: LocalExecutor, function: Callable[..., T], limits: Limits) -> None:
        self._function = function
        self._limits = limits
        self._retries = executor.retries
        self._most = executor.workers
        self._settings = (executor.calls, executor.resident_bytes)
        self._todo: SimpleQueue[Call | None] = SimpleQueue()
        self._done: SimpleQueue[tuple[Call, Outcome[T]]] = SimpleQueue()
        self._dismissed = Event()
        self._members: list[tuple[Thread, WarmChild]] = []

    def ask(self, call: Call) -> None:
        if len(self._members) < self._most:
            child = WarmChild(*self._settings)
            thread = Thread(
                target=self._serve, args=(child,), name=f"build-{len(self._members)}", daemon=True
            )
            self._members.append((thread, child))
            thread.start()
        self._todo.put(call)

    def answer(self) -> tuple[Call, Outcome[T]]:
        return self._done.get()

    def dismiss(self) -> None:
        """End all workers at once; what is under way is lost."""
        self._dismissed.set()
        for _, child in self._members:
            child.abandon()
            self._todo.put(None)
        for thread, child in self._members:
            thread.join()
            child.close()

    def _serve(self, child: WarmChild) -> None:
        while (call := self._todo.get()) is not None and not self._dismissed.is_set():
            self._done.put((call, self._tried(child, call)))

    def _tried(self, child: WarmChild, call: Call) -> Outcome[T]:
        tries = 0
        deaths: tuple[str, ...] = ()
        while True:
            try:
                outcome = child.call(self._function, limits=self._limits, **call.arguments)
            except Exception as error:  # noqa: BLE001 - no process, no folder, no pickle: this call's failure alone
                return Outcome(
                    None,
                    Failure.RAISED,
                    f"{type(error).__name__}: {error}",
                    "",
                    0.0,
                    error,
                    tries + 1,
                )
            tries += outcome.tries
            deaths += outcome.deaths
            if tries > self._retries or not worth_another_try(outcome) or self._dismissed.is_set():
                return replace(outcome, tries=tries, deaths=deaths)
            child.close()


def worth_another_try(outcome: Outcome[T]) -> bool:
    """Tell whether an outcome may have been bad luck: a crash, a hang, a moment without memory."""
    return outcome.failure in (Failure.CRASHED, Failure.TIMEOUT) or isinstance(
        outcome.error, MemoryError
    )
