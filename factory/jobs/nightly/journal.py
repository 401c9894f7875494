"""What a night appends to while it runs: attempts done so far, and a log of what happened when."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path

from ...report.nightly.formats import stamp
from ...report.nightly.night import NightResult, attempt_from


@contextmanager
def journal(path: Path) -> Iterator[Callable[[NightResult], None]]:
    """Append to a journal: gives a function that returns when an attempt is on the disk.

    A night that dies loses nothing; a line that it left half written is ended, and passed over.
    """
    torn = path.is_file() and path.read_bytes()[-1:] not in (b"", b"\n")
    with path.open("ab", buffering=0) as file:

        def add(attempt: NightResult) -> None:
            file.write(json.dumps(asdict(attempt)).encode() + b"\n")
            os.fsync(file.fileno())

        if torn:
            file.write(b"\n")
        yield add


def read_journal(path: Path) -> tuple[NightResult, ...]:
    """Return all whole lines of a journal, in their order; empty if there is none."""
    attempts = []
    for line in path.read_bytes().splitlines() if path.is_file() else ():
        try:
            attempts.append(attempt_from(json.loads(line)))
        except (ValueError, AttributeError, TypeError):
            continue
    return tuple(attempts)


def utc_now() -> datetime:
    """Return the time."""
    return datetime.now(UTC)


@contextmanager
def log(path: Path, now: Callable[[], datetime] = utc_now) -> Iterator[Callable[[str], None]]:
    """Append to a log: gives a function that writes one line, with the time before it."""
    with path.open("a", encoding="utf-8", errors="backslashreplace", buffering=1) as file:

        def write(line: str) -> None:
            told = "".join(c if c.isprintable() else " " for c in line)
            file.write(f"{stamp(now())} {told}\n")

        yield write
