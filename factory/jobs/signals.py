"""Interruptions: by Ctrl-C or SIGTERM, never in the middle of a registration."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import NoReturn

ENDING = (signal.SIGINT, signal.SIGTERM)


class Terminated(KeyboardInterrupt):
    """SIGTERM: as good as Ctrl-C, for services and batch systems."""


@contextmanager
def interruptible(first: Callable[[], None] | None = None) -> Iterator[None]:
    """Have SIGTERM raise :class:`Terminated` within this, as Ctrl-C would; main thread only.

    Args:
        first: what the first Ctrl-C does; the second one is a KeyboardInterrupt. ``None``: the
            first one is.
    """

    def begun(_number: int, _frame: FrameType | None) -> None:
        signal.signal(signal.SIGINT, signal.default_int_handler)
        if first is not None:
            first()

    before = {
        signal.SIGTERM: signal.signal(signal.SIGTERM, _terminated),
        signal.SIGINT: signal.getsignal(signal.SIGINT),
    }
    if first is not None:
        signal.signal(signal.SIGINT, begun)
    try:
        yield
    finally:
        for ending, handler in before.items():
            signal.signal(ending, handler)


@contextmanager
def undisturbed() -> Iterator[None]:
    """Have Ctrl-C and SIGTERM wait until its end; in the main thread, where they arrive."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    came: list[int] = []
    before = {
        ending: signal.signal(ending, lambda number, _: came.append(number)) for ending in ENDING
    }
    try:
        yield
    finally:
        for ending, handler in before.items():
            signal.signal(ending, handler)
        if came:
            signal.raise_signal(signal.Signals(came[0]))


def _terminated(number: int, frame: FrameType | None) -> NoReturn:
    raise Terminated
