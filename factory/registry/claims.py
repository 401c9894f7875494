"""Who works on what: locks by name, so that two jobs on one registry do nothing twice."""

from __future__ import annotations

import fcntl
import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

#: In a registry's folder: where its jobs claim their work.
#: How often to ask again for what somebody else has [s].
WAIT_S = 0.02


class Claim:
    """The right to do one piece of work, until released or until this process ends anyhow."""

    def __init__(self, path: Path, descriptor: int) -> None:
        self._path = path
        self._descriptor = descriptor

    def release(self) -> None:
        """Let others have it; once."""
        # Whoever has the file open still finds, after locking it, that it is no longer the one at
        # that path.
        self._path.unlink(missing_ok=True)
        os.close(self._descriptor)


def claim(folder: Path, name: str) -> Claim | None:
    """The right to do the work of that name; ``None`` while somebody else has it.

    Args:
        folder: that all jobs share; made if need be.
        name: of the work; a file name.
    """
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / name
    while True:
        descriptor = os.open(path, os.O_RDWR | os.O_CREAT, 0o644)
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            os.close(descriptor)
            return None
        except OSError:
            # A file system without locks: doing a thing twice is better than not at all.
            return Claim(path, descriptor)
        if _is_at(path, descriptor):
            return Claim(path, descriptor)
        os.close(descriptor)


@contextmanager
def alone(folder: Path, name: str) -> Iterator[None]:
    """Within this nobody else has that name; waits while somebody has."""
    while (held := claim(folder, name)) is None:
        time.sleep(WAIT_S)
    try:
        yield
    finally:
        held.release()


def drop_abandoned(folder: Path) -> int:
    """Remove the claims of processes that were killed; how many there were."""
    count = 0
    for path in folder.iterdir() if folder.is_dir() else ():
        held = claim(folder, path.name)
        if held is not None:
            held.release()
            count += 1
    return count


def _is_at(path: Path, descriptor: int) -> bool:
    try:
        return os.path.samestat(path.stat(), os.fstat(descriptor))
    except FileNotFoundError:
        return False
