"""Folders for half-made things that say whether anybody still works in them."""

from __future__ import annotations

import fcntl
import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

STAGING_NAME = ".staging"


@contextmanager
def held_folder(parent: Path) -> Iterator[Path]:
    """A fresh folder in ``parent``, locked while the process lives; removed afterwards with whatever is still in it."""
    parent.mkdir(parents=True, exist_ok=True)
    folder, descriptor = _made(parent)
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)
        os.close(descriptor)


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """The right to do what only one process may do at a time in a folder; waits for it."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        with suppress(OSError):
            fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield
    finally:
        os.close(descriptor)


def abandoned(folder: Path) -> int | None:
    """A lock on a staging folder that nobody works in, as a file descriptor to close; ``None`` if somebody does.

    Where the file system knows no locks, somebody always does.
    """
    try:
        descriptor = os.open(folder, os.O_RDONLY | os.O_NOFOLLOW)
    except OSError:
        return None
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        os.close(descriptor)
        return None
    return descriptor


def _made(parent: Path) -> tuple[Path, int]:
    while True:
        folder = Path(tempfile.mkdtemp(dir=parent))
        folder.chmod(0o755)
        try:
            descriptor = os.open(folder, os.O_RDONLY)
        except FileNotFoundError:
            continue
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX)
        except OSError:
            # No locks on this file system; gc leaves such folders alone.
            return folder, descriptor
        # A gc that came between making and locking has taken it for abandoned.
        if folder.exists():
            return folder, descriptor
        os.close(descriptor)
