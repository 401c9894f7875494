"""``factory list``: what a registry holds."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field

import tyro

from ..errors import ConfigError, Exit
from ..registry import Registry
from ..runtime.terminal import say
from . import console
from .flags import EntryFilters, OfRegistry, Printed

#: Rows of a table that nobody set a limit for.
TABLE_ROWS = 200


@dataclass(frozen=True)
class List(Printed, OfRegistry):
    """List what a registry holds.

    Example: factory list --output out/ --limit 20
    """

    limit: int | None = None
    """Rows at most; 0: all. Without it a table has up to 200, JSON all."""
    after: str = ""
    """Go on after the row of this id."""
    wanted: tyro.conf.OmitArgPrefixes[EntryFilters] = field(default_factory=EntryFilters)
    """Which assets."""


def run(command: List) -> int:
    """Print the rows; returns the exit code."""
    registry = Registry(command.output)
    filters = command.wanted.filters()
    if command.limit is not None and command.limit < 0:
        raise ConfigError(f"--limit must be at least 0, not {command.limit}")
    limit = command.limit if command.limit is not None else 0 if command.json else TABLE_ROWS
    # One more than asked for says whether there are more.
    found = registry.select(filters, limit=limit + 1 if limit else None, after=command.after)
    entries = found[: limit or None]
    if command.json:
        say(json.dumps([asdict(entry) for entry in entries], indent=2))
        return Exit.OK
    console.print_entries(entries)
    if len(found) > len(entries):
        say(f"the first {len(entries)}; --after {entries[-1].id} goes on, --limit 0 shows all")
    return Exit.OK
