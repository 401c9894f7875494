"""A run's folder belongs to one run at a time."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from filelock import FileLock, Timeout

from asset_factory.factory.errors import ConfigError

_LOCK = ".lock"


@contextmanager
def held(folder: Path) -> Iterator[None]:
    """Lock a folder against every other training; the lock ends with this process, always.

    Args:
        folder: there, and may be written to.

    Raises:
        ConfigError: another training has it.
    """
    lock = FileLock(folder / _LOCK, fallback_to_soft=False)
    try:
        lock.acquire(blocking=False)
    except Timeout:
        raise ConfigError(
            f"{folder}: another process is training there; wait for it, or name another folder"
        ) from None
    try:
        yield
    finally:
        lock.release()
