"""A run's folder belongs to one run at a time."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ..errors import ConfigError

_LOCK = ".lock"


@contextmanager
def held(folder: Path) -> Iterator[None]:
    """Lock a folder against every other training; the lock ends with this process, always.

    Args:
        folder: there, and may be written to.

    Raises:
        ConfigError: another training has it.
    """
    try:
        import fcntl
    except ImportError:  # Where there are no such locks, people have to mind for themselves.
        yield
        return
    with (folder / _LOCK).open("wb") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise ConfigError(
                f"{folder}: another process is training there; wait for it, or name another folder"
            ) from None
        yield
