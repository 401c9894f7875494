"""Temporary folders that show whether their owner lives, so that a killed process's are found."""

from __future__ import annotations

import multiprocessing
import multiprocessing.util
import os
import shutil
import tempfile
from contextlib import suppress
from pathlib import Path

from filelock import lock_descriptor

#: How scratch folders begin; a name that nobody else gives to theirs.
PREFIX = "asset-factory-"
#: A socket's path may have 104 bytes on some systems, of which 24 are left for names below.
LONGEST_WITH_SOCKETS = 80
#: Where sockets lie when temporary files have too long a way.
SHORT = Path("/tmp")  # noqa: S108 - the folder made there is its owner's alone


def held_folder(parent: Path, prefix: str = "") -> tuple[Path, int]:
    """Make a folder and its lock: a file descriptor to close when nobody works in it any more."""
    while True:
        folder = Path(tempfile.mkdtemp(dir=parent, prefix=prefix))
        with suppress(FileNotFoundError):
            descriptor = os.open(folder, os.O_RDONLY)
            if hold(folder, descriptor):
                return folder, descriptor


def hold(path: Path, descriptor: int) -> bool:
    """Lock a file or folder just made; return False, and close it, where somebody took it.

    That is who came between making and locking. Where there are no locks, nobody takes anything.
    """
    with suppress(OSError):
        lock_descriptor(descriptor)
    if path.exists():
        return True
    os.close(descriptor)
    return False


def abandoned(path: Path) -> int | None:
    """Lock a folder or file that nobody uses; return a file descriptor to close, or ``None``.

    Where the file system knows no locks, somebody always does.
    """
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW)
    except OSError:
        return None
    with suppress(OSError):
        if lock_descriptor(descriptor, blocking=False):
            return descriptor
    os.close(descriptor)
    return None


def sweep(parent: Path | None = None) -> int:
    """Remove killed processes' scratch folders, by default beside temporary files; how many."""
    count = 0
    for folder in Path(parent or tempfile.gettempdir()).glob(f"{PREFIX}*"):
        descriptor = abandoned(folder)
        if descriptor is not None:
            shutil.rmtree(folder, ignore_errors=True)
            os.close(descriptor)
            count += 1
    return count


_folders: dict[tuple[int, Path], Path] = {}


def scratch() -> Path:
    """Return this process's folder for temporary files, removed when it ends.

    If it is killed, the next process to ask for its own folder removes it. Only its owner can look
    into it.
    """
    folder = _own_folder(Path(tempfile.gettempdir()))
    # The socket of a fork server that is yet to be started shall lie there too.
    config = vars(multiprocessing.current_process()).get("_config", {})
    if "tempdir" not in config:
        config["tempdir"] = str(sockets())
    return folder


def sockets() -> Path:
    """Return this process's folder for sockets: its scratch folder, or one of a shorter path."""
    folder = _own_folder(Path(tempfile.gettempdir()))
    return folder if len(os.fsencode(folder)) <= LONGEST_WITH_SOCKETS else _own_folder(SHORT)


def _own_folder(parent: Path) -> Path:
    """Return this process's folder in a parent; what killed processes left there goes first."""
    folder = _folders.get((os.getpid(), parent))
    if folder is None or not folder.is_dir():
        sweep(parent)
        # The lock lasts as long as the process.
        folder, _ = held_folder(parent, PREFIX)
        _folders[os.getpid(), parent] = folder
        # After multiprocessing's own; in a child these alone are called.
        multiprocessing.util.Finalize(None, shutil.rmtree, (folder, True), exitpriority=-200)
    return folder
