"""What a night keeps while it runs: its lock, attempts so far, and a log of what happened when."""

from __future__ import annotations

import json
import os
import platform
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict
from datetime import datetime
from pathlib import Path

from ...errors import ConfigError
from ...registry.claims import claim
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
        except ValueError:
            continue
    return tuple(attempts)


@contextmanager
def log(path: Path, now: Callable[[], datetime]) -> Iterator[Callable[[str], None]]:
    """Append to a log: gives a function that writes one line, with the time before it."""
    with path.open("a", encoding="utf-8", errors="backslashreplace", buffering=1) as file:

        def write(line: str) -> None:
            told = "".join(c if c.isprintable() else " " for c in line)
            file.write(f"{stamp(now())} {told}\n")

        yield write


@contextmanager
def locked(nights: Path) -> Iterator[Callable[[str], None]]:
    """Keep other nights off a folder of nights; the lock ends with this process, in any case.

    Gives a function that takes this night's name, to be told to whoever is refused.

    Raises:
        ConfigError: another night runs there; says which, where and what to do.
    """
    held = claim(nights, ".lock")
    holder = nights / ".holder"
    if held is None:
        who = holder.read_text(encoding="utf-8") if holder.is_file() else "a process"
        advice = "wait for it, end it, or name another --output"
        raise ConfigError(f"{nights}: another night runs here ({who}); {advice}")
    process = f"process {os.getpid()} on {platform.node() or 'this machine'}"

    def announce(night: str) -> None:
        holder.write_text(f"night {night}, {process}", encoding="utf-8")

    try:
        holder.unlink(missing_ok=True)
        yield announce
    finally:
        holder.unlink(missing_ok=True)
        held.close()
