"""Interruptions: by Ctrl-C or SIGTERM, never in the middle of a registration."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import NoReturn

ENDING = (signal.SIGINT, signal.SIGTERM)


class Terminated(KeyboardInterrupt):
    """SIGTERM: as good as Ctrl-C, for services and batch systems."""


@contextmanager
def interruptible() -> Iterator[None]:
    """Within this, SIGTERM raises :class:`Terminated`, like KeyboardInterrupt; main thread only."""
    before = signal.signal(signal.SIGTERM, _terminated)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


@contextmanager
def undisturbed() -> Iterator[None]:
    """Within this, Ctrl-C and SIGTERM wait until its end; in the main thread, where they arrive."""
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
