"""``factory gc``: what a registry holds besides assets, and room made of it."""

from __future__ import annotations

from dataclasses import dataclass

from rich.filesize import decimal
from rich.table import Table

from ..errors import ConfigError, Exit
from ..registry import Registry
from ..registry.cleaning import collect_garbage
from ..runtime.terminal import Terminal, say
from .flags import OfRegistry

_GB = 1e9
_DAY_S = 86_400.0


@dataclass(frozen=True)
class Gc(OfRegistry):
    """Remove leftovers of dead processes, and cached results by age and size.

    Never what a running job holds: its staging folders are locked, and results of the last hour
    stay. A build keeps the cache below `cache_gb` of its settings by itself.

    Example: factory gc --output out/ --keep-gb 0
    """

    older_than: float | None = None
    """Remove cached results that were not used for so many days."""
    keep_gb: float | None = None
    """Keep at most so much of the cache [GB]; the longest unused goes first."""


def run(command: Gc) -> int:
    """Remove it; returns the exit code."""
    for name, value in (("older-than", command.older_than), ("keep-gb", command.keep_gb)):
        if value is not None and not value >= 0.0:
            raise ConfigError(f"--{name} must be at least 0, not {value:g}")
    freed = collect_garbage(
        Registry(command.output).root,
        older_than_s=None if command.older_than is None else command.older_than * _DAY_S,
        keep_bytes=None if command.keep_gb is None else int(command.keep_gb * _GB),
    )
    table = Table("what", "files", "size")
    for name in ("staging", "unfinished", "cache"):
        removed = getattr(freed, name)
        table.add_row(name, str(removed.files), decimal(removed.bytes))
    Terminal().print(table)
    say(f"freed {decimal(freed.bytes)}")
    if freed.kept.files:
        smaller = "" if command.keep_gb is not None else "; --keep-gb 1 makes it smaller"
        say(f"the cache holds {freed.kept.files} results, {decimal(freed.kept.bytes)}{smaller}")
    return Exit.OK
