"""Folders for half-made things that say whether anybody still works in them."""

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from filelock import lock_descriptor

from asset_factory.sim_checks.processes import scratch


@contextmanager
def held_folder(parent: Path) -> Iterator[Path]:
    """Make a folder in ``parent``, locked while the process lives, removed afterwards."""
    parent.mkdir(parents=True, exist_ok=True)
    folder, descriptor = scratch.held_folder(parent)
    folder.chmod(0o755)
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)
        os.close(descriptor)


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Yield the right to do what only one process may do at a time in a folder; waits for it."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        with suppress(OSError):
            lock_descriptor(descriptor)
        yield
    finally:
        os.close(descriptor)
