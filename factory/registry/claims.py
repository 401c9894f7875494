"""Who works on what: claims by name, so that no two jobs do the same, and folders in use."""

from __future__ import annotations

import errno
import os
import shutil
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path

from filelock import FileLock, Timeout

from asset_factory.sim_checks.processes import scratch

#: How often to ask again for what somebody else has [s].
WAIT_S = 0.02
#: What a file system without locks says.
_NO_LOCKS = (errno.ENOSYS, errno.ENOTSUP, errno.EOPNOTSUPP, errno.ENOLCK, errno.EINVAL)


class Claim:
    """The right to do one piece of work, until closed or until this process ends anyhow."""

    def __init__(self, path: Path, lock: FileLock) -> None:
        self._path = path
        self._lock = lock

    def close(self) -> None:
        """Let others have it; once."""
        # Whoever has the file open still finds, after locking it, that it has no name any more.
        self._path.unlink(missing_ok=True)
        self._lock.release()


def claim(folder: Path, name: str) -> Claim | None:
    """Return the right to do the work of that name; ``None`` while somebody else has it.

    ``folder`` is shared by all jobs, and made if need be.
    """
    folder.mkdir(parents=True, exist_ok=True)
    # Not by the mere existence of a file, which would outlive a killed process.
    lock = FileLock(folder / name, mode=0o644, thread_local=False, fallback_to_soft=False)
    try:
        lock.acquire(blocking=False)
    except Timeout:
        return None
    except OSError as error:
        # A file system without locks: doing a thing twice is better than not at all.
        if error.errno not in _NO_LOCKS:
            raise
    return Claim(folder / name, lock)


@contextmanager
def alone(folder: Path, name: str) -> Iterator[None]:
    """Hold the claim of a name; waits while somebody else has it."""
    while (held := claim(folder, name)) is None:
        time.sleep(WAIT_S)
    with closing(held):
        yield


def drop_abandoned(folder: Path) -> None:
    """Remove the claims of processes that were killed."""
    for path in folder.iterdir() if folder.is_dir() else ():
        held = claim(folder, path.name)
        if held is not None:
            held.close()


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
