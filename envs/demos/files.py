"""Files: episodes that wait for their shard, and shards, which a reader sees whole or not at all.

A shard is ``NAME.h5`` and ``NAME.json``, as ManiSkill's recorder writes them. The JSON comes first:
an ``.h5`` that can be seen is complete, and its JSON is there. A shard without a trajectory has no
``.h5``.
"""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import Any

from asset_factory.factory.runtime.store import WRITING_PREFIX, sync_folder, write_json

from .episodes import VERSION, Episode, Settings, Shard, Taken

#: Finished episodes whose shards are not.
WAITING = ".episodes"
#: How their trajectories end: not as those of shards do.
TRAJECTORY = ".trajectory"
#: Where in a shard's JSON the rest of what was found lies, beside what ManiSkill reads.
OURS = "asset_factory"
SOURCE = "motionplanning"
DESCRIBED = (
    "A scripted robot of asset_factory.envs.solving, acted again before ManiSkill's recorder."
)
GROUP = "traj_0"


def keep_episode(folder: Path, settings: Settings, taken: Taken, trajectory: Path | None) -> None:
    """Keep what came of an episode, in a folder of episodes, until its shard is written.

    Its trajectory, an ``.h5`` in the same folder with no other, is moved.
    """
    key = taken.episode.key(settings)
    if trajectory is not None:
        _sync(trajectory)
        os.replace(trajectory, folder / f"{key}{TRAJECTORY}")
    write_json(folder / f"{key}.json", _row(taken), lasting=True)


def kept_episode(folder: Path, settings: Settings, episode: Episode) -> Taken | None:
    """Return an episode that was kept, unless nothing is known of it."""
    key = episode.key(settings)
    try:
        taken = _taken(json.loads((folder / f"{key}.json").read_text(encoding="utf-8")), episode)
    except (OSError, ValueError, KeyError, TypeError):
        return None
    there = taken.info is None or (folder / f"{key}{TRAJECTORY}").is_file()
    return taken if taken.judged and there else None


def forget_episodes(folder: Path, settings: Settings, shard: Shard) -> None:
    """Remove the kept episodes of a shard that was written."""
    for episode in shard.episodes:
        for ending in (".json", TRAJECTORY):
            (folder / f"{episode.key(settings)}{ending}").unlink(missing_ok=True)


def write_shard(
    target: Path,
    episodes: Path,
    shard: Shard,
    taken: Sequence[Taken],
    settings: Settings,
    registry: str,
) -> None:
    """Put kept episodes of a folder together in a shard's order; ``target`` is that of shards."""
    kept = [each for each in taken if each.info is not None]
    file = target / f"{shard.name}.h5"
    # No name that somebody who looks for .h5 would find.
    temporary = target / f"{WRITING_PREFIX}{shard.name}"
    if kept:
        keys = [each.episode.key(settings) for each in kept]
        _put_together(temporary, [episodes / f"{key}{TRAJECTORY}" for key in keys])
        _sync(temporary)
    # What is there belongs to another JSON than the one that comes now.
    file.unlink(missing_ok=True)
    data = _described(shard, taken, settings, registry)
    write_json(target / f"{shard.name}.json", data, lasting=True)
    if kept:
        os.replace(temporary, file)
    sync_folder(target)


def read_shard(target: Path, shard: Shard, settings: Settings) -> tuple[Taken, ...] | None:
    """Return what a shard says, if it is there, has the same episodes and leaves none open."""
    try:
        data = json.loads((target / f"{shard.name}.json").read_text(encoding="utf-8"))
        if data[OURS]["key"] != shard.key(settings):
            return None
        rows = [_with_info(row, data["episodes"]) for row in data[OURS]["attempts"]]
        pairs = zip(rows, shard.episodes, strict=True)
        taken = tuple(_taken(row, episode) for row, episode in pairs)
    except (OSError, ValueError, LookupError, TypeError):
        return None
    complete = all(each.judged for each in taken)
    there = all(each.info is None for each in taken) or (target / f"{shard.name}.h5").is_file()
    return taken if complete and there else None


def clear_unfinished(target: Path) -> None:
    """Remove what a run left that was killed; none other may be at work."""
    for path in [*target.glob(f"{WRITING_PREFIX}*"), *(target / WAITING).glob("*-recording.*")]:
        path.unlink(missing_ok=True)
    with suppress(OSError):  # Not empty.
        (target / WAITING).rmdir()


def _put_together(path: Path, sources: Sequence[Path]) -> None:
    import h5py

    with h5py.File(path, "w") as target:
        for number, source in enumerate(sources):
            with h5py.File(source, "r") as file:
                file.copy(GROUP, target, f"traj_{number}")


def _described(
    shard: Shard, taken: Sequence[Taken], settings: Settings, registry: str
) -> dict[str, Any]:
    entries: list[dict[str, Any]] = []
    rows = []
    for each in taken:
        row = _row(each)
        info = row.pop("info")
        row["episode_id"] = None if info is None else len(entries)
        if info is not None:
            entries.append({**info, "episode_id": len(entries)})
        rows.append(row)
    ours = {"version": VERSION, "key": shard.key(settings), "settings": asdict(settings)}
    return {
        "env_info": settings.env_info(registry),
        "commit_info": None,
        "episodes": entries,
        "source_type": SOURCE,
        "source_desc": DESCRIBED,
        OURS: {**ours, "attempts": rows},
    }


def _row(taken: Taken) -> dict[str, Any]:
    row = asdict(taken)
    return {**row.pop("episode"), **row}


def _with_info(row: dict[str, Any], entries: Sequence[dict[str, Any]]) -> dict[str, Any]:
    row = dict(row)
    number = row.pop("episode_id")
    return {**row, "info": None if number is None else entries[number]}


def _taken(row: dict[str, Any], episode: Episode) -> Taken:
    facts = {name: value for name, value in row.items() if name not in asdict(episode)}
    return Taken(episode, **facts)


def _sync(path: Path) -> None:
    with path.open("rb+") as file:
        os.fsync(file.fileno())
