"""What becomes of damage: rows are made anew, what nothing can mend is moved aside."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from enum import StrEnum
from pathlib import Path

from ..runtime.layout import WITHDRAWN
from . import rows
from .database import writing
from .rebuild import write_rows
from .registry import Registry
from .verify import Problem, verify

#: Kinds of problems that the folders alone mend.
_OF_ROWS = frozenset({"stale", "unlisted", "lost", "twice"})


class Settled(StrEnum):
    """What became of a damaged asset."""

    MENDED = "mended"
    """It is whole again."""
    WITHDRAWN = "withdrawn"
    """It is registered no more."""
    LEFT = "left"
    """It is as it was: there was no time to make it again."""


def mend_rows(registry: Registry, problems: Iterable[Problem]) -> None:
    """Bring rows in line with their folders, as far as they are concerned; no file is touched."""
    ids = sorted({problem.id for problem in problems if problem.kind in _OF_ROWS})
    if ids:
        write_rows(registry.root, ids)


def settle(
    registry: Registry, problems: Iterable[Problem], *, final: bool = True
) -> dict[str, Settled]:
    """Return what became of damaged assets, once all that can be made again was.

    What was added to a folder, and assets that still are not what was registered, are moved to
    ``withdrawn``: nobody takes them for assets any more, and nothing is lost.

    Args:
        registry: others may use it meanwhile.
        problems: as they were found.
        final: whether all was tried; otherwise assets are left as they are.

    Returns:
        By id, sorted.
    """
    ids = sorted({problem.id for problem in problems})
    return {asset_id: _settled(registry, asset_id, final) for asset_id in ids}


def withdraw(registry: Registry, asset_id: str) -> None:
    """Drop an asset's row, and move its folder to ``withdrawn``; what was noted of it stays."""
    # As elsewhere the row goes first and for good: no reader is sent to a folder that is gone.
    with writing(registry.root) as connection:
        rows.delete(connection, asset_id)
    with writing(registry.root) as connection:
        if rows.find(connection, "id", asset_id) is not None:
            return
        for folder in (registry.assets / asset_id, registry.rejected / asset_id):
            if os.path.lexists(folder):
                _set_aside(registry, folder, Path(asset_id))


def _settled(registry: Registry, asset_id: str, final: bool) -> Settled:
    left = verify(registry, (asset_id,))
    if left and {problem.kind for problem in left} == {"extra"}:
        _set_extras_aside(registry, asset_id, left)
        left = verify(registry, (asset_id,))
    if not left:
        known = registry.find(asset_id) is not None
        return Settled.MENDED if known else Settled.WITHDRAWN
    if not final:
        return Settled.LEFT
    withdraw(registry, asset_id)
    return Settled.WITHDRAWN


def _set_extras_aside(registry: Registry, asset_id: str, extras: Sequence[Problem]) -> None:
    with writing(registry.root):
        for problem in extras:
            path = registry.root / problem.path
            # Somebody may have published it anew meanwhile.
            if os.path.lexists(path):
                _set_aside(registry, path, Path(*path.relative_to(registry.root).parts[1:]))


def _set_aside(registry: Registry, path: Path, name: Path) -> None:
    """Move something into ``withdrawn``; what an earlier damage left there goes."""
    target = registry.root / WITHDRAWN / name
    target.parent.mkdir(parents=True, exist_ok=True)
    with registry.staging_folder() as staging:
        if os.path.lexists(target):
            os.rename(target, staging / "before")
        os.rename(path, target)
