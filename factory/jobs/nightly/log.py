"""``night.log``: what happened when."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path

from .words import stamp


def utc_now() -> datetime:
    """The time."""
    return datetime.now(UTC)


@contextmanager
def log(path: Path, now: Callable[[], datetime] = utc_now) -> Iterator[Callable[[str], None]]:
    """Append to a log: gives a function that writes one line, with the time before it."""
    with path.open("a", encoding="utf-8", errors="backslashreplace", buffering=1) as file:

        def write(line: str) -> None:
            told = "".join(c if c.isprintable() else " " for c in line)
            file.write(f"{stamp(now())} {told}\n")

        yield write
