"""Folders put in place by one rename, so that a reader finds the old or the new one, whole."""

from __future__ import annotations

import ctypes
import errno
import os
import shutil
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from ..errors import RegistryError
from ..runtime.store import sync_folder

_AT_FDCWD = -100
_RENAME_EXCHANGE = 2
#: Files synced side by side.
_AT_ONCE = 16
_NO_EXCHANGE = frozenset({errno.ENOSYS, errno.EINVAL, errno.EOPNOTSUPP})


def place(content: Path, folder: Path) -> None:
    """Put ``content`` at ``folder``; a folder that was there ends up at ``content``.

    Both are on one file system; ``folder`` need not exist.
    """
    try:
        if os.path.lexists(folder):
            exchange(content, folder)
        else:
            os.rename(content, folder)
    except OSError as error:
        if error.errno != errno.EXDEV:
            raise
        elsewhere = f"{content}: lies on another file system than {folder.parent}"
        raise RegistryError(f"{elsewhere}; build in the registry's staging folder") from error
    sync_folder(folder.parent)


def exchange(first: Path, second: Path) -> None:
    """Let two folders change places: atomically where the system can, else by renames."""
    number = _exchanged(first, second)
    if number == 0:
        return
    if number not in _NO_EXCHANGE:
        raise OSError(number, os.strerror(number), str(first), None, str(second))
    between = first.with_name(f"{first.name}.exchanged")
    os.rename(second, between)
    os.rename(first, second)
    os.rename(between, first)


def sync_tree(folder: Path) -> None:
    """Have a folder and everything in it on the disk."""
    files = []
    folders = []
    for parent, _, names in os.walk(folder):
        files += [os.path.join(parent, name) for name in names]
        folders.append(Path(parent))
    # A file system writes down together what is asked of it at the same time.
    with ThreadPoolExecutor(_AT_ONCE) as pool:
        list(pool.map(_sync_file, files))
        list(pool.map(sync_folder, folders))


def _sync_file(path: str) -> None:
    descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def remove(path: Path) -> None:
    """Delete a folder or a file, if it is there."""
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path, ignore_errors=True)
    else:
        path.unlink(missing_ok=True)


def _exchanged(first: Path, second: Path) -> int:
    """Call Linux's exchanging rename; returns 0, or the error's number."""
    call = getattr(ctypes.CDLL(None, use_errno=True), "renameat2", None)
    if call is None:
        return errno.ENOSYS
    one, other = (os.fsencode(path) for path in (first, second))
    failed = call(_AT_FDCWD, one, _AT_FDCWD, other, ctypes.c_uint(_RENAME_EXCHANGE))
    return ctypes.get_errno() if failed else 0
