"""One night at a time on one output."""

from __future__ import annotations

import os
import platform
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from filelock import FileLock, Timeout

from ...errors import ConfigError


@contextmanager
def locked(nights: Path) -> Iterator[Callable[[str], None]]:
    """Keep other nights off a folder of nights; the lock ends with this process, in any case.

    Gives a function that takes this night's name, to be told to whoever is refused.

    Raises:
        ConfigError: another night runs there; says which, where and what to do.
    """
    lock = FileLock(nights / ".lock", blocking=False)
    holder = nights / ".holder"
    try:
        lock.acquire()
    except Timeout:
        who = holder.read_text(encoding="utf-8") if holder.is_file() else "a process"
        advice = "wait for it, end it, or name another --output"
        raise ConfigError(f"{nights}: another night runs here ({who}); {advice}") from None
    process = f"process {os.getpid()} on {platform.node() or 'this machine'}"

    def announce(night: str) -> None:
        holder.write_text(f"night {night}, {process}", encoding="utf-8")

    try:
        holder.unlink(missing_ok=True)
        yield announce
    finally:
        holder.unlink(missing_ok=True)
        lock.release()
