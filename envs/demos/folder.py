"""A folder of demonstrations: one run at a time, of one kind, with every episode in one file."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager, suppress
from pathlib import Path
from typing import Any

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.registry.claims import claim

from .episodes import Settings, Shard
from .files import OURS

LOCK = ".lock"
#: What all files of a folder share.
KIND = ("task", "robot", "obs_mode", "control_mode")


@contextmanager
def hold(target: Path, settings: Settings, shards: Sequence[Shard]) -> Iterator[None]:
    """Keep every other run out of a folder of demonstrations; it is made if need be.

    The episodes to come are to lie in some shards.

    Raises:
        ConfigError: another run is at work there; it holds demonstrations of another kind, such
            that would be lost, or such that would be there twice.
    """
    target.mkdir(parents=True, exist_ok=True)
    held = claim(target, LOCK)
    if held is None:
        remedy = "wait for it, or name another --to"
        raise ConfigError(f"{target}: another run writes demonstrations here; {remedy}")
    with closing(held):
        _require_room(target, settings, shards)
        yield


def _require_room(target: Path, settings: Settings, shards: Sequence[Shard]) -> None:
    places = {episode: shard.name for shard in shards for episode in shard.episodes}
    planned = {(each.asset, each.joint, each.seed): name for each, name in places.items()}
    current = {(each.asset, each.digest) for each in places}
    names = {shard.name for shard in shards}
    kind = tuple(str(getattr(settings, name)) for name in KIND)
    for name, data in _described(target):
        there = tuple(str(data["settings"][each]) for each in KIND)
        if there != kind:
            holds = f"{target}: holds demonstrations of {', '.join(there)}"
            raise ConfigError(f"{holds}, these are {', '.join(kind)}; name another --to")
        for row in data["attempts"]:
            place = planned.get((row["asset"], row["joint"], row["seed"]))
            lost = place is None and name in names and (row["asset"], row["digest"]) in current
            if lost or place not in (None, name):
                fate = "leave out" if lost else f"put into {place}"
                holds = f"holds {row['asset']} {row['joint']} seed {row['seed']}"
                remedy = "remove that file and its .h5, or name another --to"
                words = f"{holds}, which these flags {fate}; {remedy}"
                raise ConfigError(f"{target}/{name}.json: {words}")


def _described(target: Path) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield what each shard in a folder says of itself, by name."""
    for path in sorted(target.glob("*.json")):
        with suppress(OSError, ValueError, LookupError, TypeError):
            data = json.loads(path.read_text(encoding="utf-8"))[OURS]
            yield path.stem, {"settings": data["settings"], "attempts": data["attempts"]}
