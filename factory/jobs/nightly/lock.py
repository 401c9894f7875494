"""One night at a time on one output."""

from __future__ import annotations

import os
import platform
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from ...errors import ConfigError

_LOCK = ".lock"


@contextmanager
def held(nights: Path) -> Iterator[Callable[[str], None]]:
    """Keep every other night off an output; the system lets go when this process ends, however it does.

    Args:
        nights: the folder of nights; there, and may be written to.

    Yields:
        A function that takes this night's name, to be told to whoever is refused.

    Raises:
        ConfigError: another night runs there; says which, where and what to do.
    """
    try:
        import fcntl
    except ImportError:  # Where there are no such locks, people have to mind for themselves.
        yield lambda name: None
        return
    with (nights / _LOCK).open("a+", encoding="utf-8") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            file.seek(0)
            who = file.read(200).strip() or "a process"
            raise ConfigError(
                f"{nights}: another night runs here ({who}); wait for it, end it, or name another --output"
            ) from None

        def tell(name: str) -> None:
            file.truncate(0)
            file.write(
                f"night {name}, process {os.getpid()} on {platform.node() or 'this machine'}\n"
            )
            file.flush()

        yield tell
        file.truncate(0)
