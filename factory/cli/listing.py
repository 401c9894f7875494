"""``factory list``: what a registry holds."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass

from ..errors import ConfigError, Exit
from ..registry import Registry
from ..registry.aside import superseded
from ..registry.registry import read_manifest
from ..registry.where import wanted
from ..runtime.terminal import say
from . import console
from .flags import OfRegistry, Printed

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
    superseded: bool = False
    """List superseded assets: their input became another one by a corrected sidecar."""
    where: str = ""
    """Which assets, such as "category = fridge and joints > 1"; all by default."""


def run(command: List) -> int:
    """Print the rows; returns the exit code."""
    registry = Registry(command.output)
    conditions = wanted(registry, command.where)
    if command.limit is not None and command.limit < 0:
        raise ConfigError(f"--limit must be at least 0, not {command.limit}")
    limit = command.limit if command.limit is not None else 0 if command.json else TABLE_ROWS
    # One more than asked for says whether there are more.
    more = limit + 1 if limit else None
    if command.superseded:
        found = superseded(registry.root)
    else:
        found = registry.entries(conditions, limit=more, after=command.after)
    entries = found[: limit or None]
    if command.json:
        say(json.dumps([asdict(entry) for entry in entries], indent=2))
        return Exit.OK
    if not entries:
        say(f"no assets{f' with {command.where}' if command.where else ''}")
        return Exit.OK
    console.print_entries([(each, read_manifest(registry.folder(each))) for each in entries])
    if len(found) > len(entries):
        say(f"the first {len(entries)}; --after {entries[-1].id} goes on, --limit 0 shows all")
    return Exit.OK
