"""How much a job may do, and what it does again."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from time import time

from ..errors import ConfigError

#: In place of a reason: all of them.
ANY = "any"


@dataclass(frozen=True)
class Budget:
    """Limits of one job.

    Attributes:
        limit: inputs begun at most, those known from before not counted; ``None``: all.
        max_s: after so long none is begun, and running builds are stopped [s]. ``None``: no limit.
        retry: reason codes; inputs rejected or left unjudged for one of them are built again.
            ``any``: for any.
        repair: every known input's files are compared with those published; damaged assets are
            built again.
        damaged: ids of known inputs that are built again before all others, whatever their files
            say.
    """

    limit: int | None = None
    max_s: float | None = None
    retry: tuple[str, ...] = ()
    repair: bool = False
    damaged: frozenset[str] = frozenset()

    def __post_init__(self) -> None:
        if self.limit is not None and self.limit < 0:
            raise ConfigError(f"limit must be 0 or more, not {self.limit}")
        if self.max_s is not None and not self.max_s >= 0.0:
            raise ConfigError(f"longest time must be 0 or more, not {self.max_s / 3600.0:g} h")


def parse_since(text: str) -> float:
    """Return a point in time [s since 1970].

    Args:
        text: seconds ago (``3600``), a date or a time (``2026-11-21``, ``2026-11-21T18:00``, local
            unless it says otherwise), or a file: when that was last modified.

    Raises:
        ConfigError: it is none of these.
    """
    try:
        ago = float(text)
    except ValueError:
        ago = float("nan")
    if ago >= 0.0:
        return time() - ago
    try:
        return datetime.fromisoformat(text).timestamp()
    except ValueError:
        pass
    try:
        return Path(text).stat().st_mtime
    except OSError as error:
        want = "seconds ago, a date such as 2026-11-21, or a file that is there"
        raise ConfigError(f"--since must be {want}, not {text!r}") from error


def modified_since(inputs: Iterable[Path], since: float) -> Iterator[Path]:
    """Yield those whose own file was modified at that time or later [s since 1970]."""
    for path in inputs:
        try:
            if path.stat().st_mtime >= since:
                yield path
        except OSError:
            # Whoever builds it says what is wrong with it.
            yield path
