"""``factory remove``: assets that nobody wants."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

from ..errors import ConfigError, Exit
from ..registry import Registry
from ..registry.placing import remove
from ..registry.where import wanted
from ..runtime.layout import SUPERSEDED
from ..runtime.terminal import say
from .flags import AssetIds, OfRegistry

#: Ids that are listed before they go.
LISTED = 20


@dataclass(frozen=True)
class Remove(OfRegistry):
    """Remove assets and reports of rejected inputs for good; asks first.

    The same build makes them again where their inputs are still there. Superseded ones are removed
    by their ids.

    Example: factory remove --where "status = rejected" --output out/
    """

    ids: AssetIds = ()
    """As `factory list` prints them."""
    where: str = ""
    """Remove those that meet conditions, such as "category = fridge and joints > 1"."""
    yes: bool = False
    """Do not ask."""


def run(command: Remove) -> int:
    """Remove the assets that are named; returns the exit code."""
    registry = Registry(command.output)
    if bool(command.ids) == bool(command.where):
        raise ConfigError("want ids, or --where with conditions")
    aside = [each for each in command.ids if _aside(registry, each).is_dir()]
    if command.where:
        ids = [entry.id for entry in registry.walk(wanted(registry, command.where))]
    else:
        ids = [registry.entry(each).id for each in command.ids if each not in aside]
    if not ids and not aside:
        raise ConfigError(f"nothing to remove: no asset with {command.where}")
    if not (command.yes or _confirmed([*ids, *aside])):
        say("nothing was removed")
        return Exit.OK
    for asset_id in ids:
        registry.forget(asset_id)
    for asset_id in aside:
        remove(_aside(registry, asset_id))
    say(f"{len(ids) + len(aside)} removed; `factory report --output {command.output}` renews pages")
    return Exit.OK


def _aside(registry: Registry, asset_id: str) -> Path:
    return registry.root / SUPERSEDED / Path(asset_id).name


def _confirmed(ids: list[str]) -> bool:
    """Ask; raises ConfigError where nobody can answer."""
    if not sys.stdin.isatty():
        raise ConfigError(f"would remove {len(ids)}, and nobody is there to ask; --yes does it")
    for asset_id in ids[:LISTED]:
        say(asset_id)
    if len(ids) > LISTED:
        say(f"and {len(ids) - LISTED} more")
    say(f"Remove these {len(ids)} for good? [y/N] ", end="")
    sys.stdout.flush()
    return sys.stdin.readline().strip().lower() in ("y", "yes")
