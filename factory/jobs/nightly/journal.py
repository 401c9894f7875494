"""What is done so far, a line per input, on disk before the next one is begun: a night that dies loses nothing."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict
from io import FileIO
from pathlib import Path

from .attempt import Attempt, attempt_from


class Journal:
    """Appends attempts to a file; made by :func:`journal`."""

    def __init__(self, file: FileIO) -> None:
        self._file = file

    def add(self, attempt: Attempt) -> None:
        """Write one attempt through to the disk."""
        self._file.write(
            json.dumps({**asdict(attempt), "stages": dict(attempt.stages)}).encode() + b"\n"
        )
        os.fsync(self._file.fileno())


@contextmanager
def journal(path: Path) -> Iterator[Journal]:
    """Open a journal to go on with it. A line that was only half written before is ended, and so told apart."""
    torn = path.is_file() and path.stat().st_size > 0 and not path.read_bytes().endswith(b"\n")
    with path.open("ab", buffering=0) as file:
        if torn:
            file.write(b"\n")
        yield Journal(file)


def read_journal(path: Path) -> tuple[Attempt, ...]:
    """All whole lines of a journal, in their order; empty if there is none."""
    if not path.is_file():
        return ()
    attempts = []
    for line in path.read_bytes().splitlines():
        try:
            attempts.append(attempt_from(json.loads(line)))
        except (ValueError, KeyError, TypeError):
            continue
    return tuple(attempts)
