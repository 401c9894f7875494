"""Many questions to child processes that may crash, hang or run out of memory."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import ExitStack
from queue import SimpleQueue
from typing import TypeVar

from asset_factory.sim_checks.processes.isolation import WarmChild

T = TypeVar("T")
R = TypeVar("R")


def ask_children(
    ask: Callable[[WarmChild, T], R], things: Iterable[T], workers: int, resident_bytes: int
) -> Iterator[R]:
    """Yield the answers about things as they come; an exception of one ends them all.

    ``ask`` is called in a thread, with one of ``workers`` children; one that holds more than
    ``resident_bytes`` after a call is replaced.
    """
    with ExitStack() as stack, ThreadPoolExecutor(workers, thread_name_prefix="asking") as pool:
        free: SimpleQueue[WarmChild] = SimpleQueue()
        for _ in range(workers):
            free.put(stack.enter_context(WarmChild(resident_bytes=resident_bytes)))

        def work(thing: T) -> R:
            child = free.get()
            try:
                return ask(child, thing)
            finally:
                free.put(child)

        pending = [pool.submit(work, thing) for thing in things]
        try:
            for future in as_completed(pending):
                yield future.result()
        finally:
            for future in pending:
                future.cancel()
