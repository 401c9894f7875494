"""Assets that are none any more, moved aside: damaged ones, and those whose input has changed."""

from __future__ import annotations

import os
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from ..errors import RegistryError
from ..runtime.layout import SUPERSEDED, WITHDRAWN
from .database import connected
from .entry import Entry, entry_from
from .registry import Registry
from .report_file import read_report

_TABLES = (
    "CREATE TABLE IF NOT EXISTS inputs (place BLOB, digest TEXT, id TEXT NOT NULL, "
    "PRIMARY KEY (place, digest)) WITHOUT ROWID",
    "CREATE INDEX IF NOT EXISTS inputs_by_id ON inputs (id)",
)


@dataclass(frozen=True)
class InputNow:
    """An input, and the asset that it is now.

    Attributes:
        place: of its main file.
        digest: of that file alone: a mesh in place of another is another input.
        id: of the asset.
    """

    place: Path
    digest: str
    id: str


def keep_current(registry: Registry, inputs: Sequence[InputNow]) -> tuple[str, ...]:
    """Note which asset each input is, and supersede those that no input is any more.

    The same mesh with a corrected sidecar is another asset, and the one before is wrong. Which
    input was which asset is noted in the database alone: where that is rebuilt, both stay.

    Returns the ids of the superseded.
    """
    left: list[str] = []
    if not inputs:
        return ()
    with connected(registry.root) as connection:
        # A power cut may take this back, which leaves a twin: no reason to wait for the disk.
        connection.execute("PRAGMA synchronous = NORMAL")
        connection.execute("BEGIN IMMEDIATE")
        for statement in _TABLES:
            connection.execute(statement)
        for each in inputs:
            key = (os.fsencode(each.place.absolute()), each.digest)
            query = "SELECT id FROM inputs WHERE place = ? AND digest = ?"
            before = connection.execute(query, key).fetchone()
            if before != (each.id,):
                insertion = "INSERT OR REPLACE INTO inputs VALUES (?, ?, ?)"
                connection.execute(insertion, (*key, each.id))
                left += before or ()
        # The same file elsewhere may be that asset still.
        query = "SELECT place FROM inputs WHERE id = ?"
        places = {old: connection.execute(query, (old,)).fetchall() for old in left}
        unused = [old for old in left if not any(os.path.exists(each) for (each,) in places[old])]
        connection.execute("COMMIT")
    there = tuple(old for old in unused if registry.find(old) is not None)
    for old in there:
        set_asset_aside(registry, old, SUPERSEDED)
    return there


def superseded(root: Path) -> tuple[Entry, ...]:
    """Return the entries of superseded assets, by id; what cannot be read is left out."""
    found = []
    for folder in sorted((root / SUPERSEDED).glob("*")):
        with suppress(RegistryError, ValueError, KeyError):
            found.append(entry_from(read_report(folder).entry))
    return tuple(found)


def set_asset_aside(registry: Registry, asset_id: str, where: str) -> None:
    """Drop an asset's row, and move its folder to ``where``; its notes stay."""
    with registry.unlisted(asset_id) as folders:
        for folder in folders or ():
            set_aside(registry, folder, Path(asset_id), where)


def set_aside(registry: Registry, path: Path, name: Path, where: str = WITHDRAWN) -> None:
    """Move something into the folder ``where``; what lay there under that name goes."""
    target = registry.root / where / name
    target.parent.mkdir(parents=True, exist_ok=True)
    with registry.staging_folder() as staging:
        if os.path.lexists(target):
            os.rename(target, staging / "before")
        os.rename(path, target)
