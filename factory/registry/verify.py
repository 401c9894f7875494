"""Whether a registry is as published, every file and row; and how damage is settled."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from enum import StrEnum
from itertools import chain
from pathlib import Path

from ..errors import RegistryError
from ..runtime.layout import ASSETS, REJECTED, REPORT, WITHDRAWN
from . import rows
from .aside import set_aside, set_asset_aside
from .database import connected, writing
from .folders import folders_of, known_ids, read_record
from .rebuild import write_rows
from .registry import Registry
from .report_file import file_digests, read_report


class ProblemKind(StrEnum):
    """A difference from the published asset; files are compared by digest."""

    MISSING = "missing"
    ALTERED = "altered"
    EXTRA = "extra"
    LOST = "lost"
    """A row without a folder."""
    UNLISTED = "unlisted"
    """A folder without a row."""
    STALE = "stale"
    """A row that says something else than its folder."""
    UNREADABLE = "unreadable"
    """A report that is none."""
    TWICE = "twice"
    """A folder among those that passed, and one among the others."""


#: Kinds of problems that the folders alone mend.
_OF_ROWS = frozenset({ProblemKind.STALE, ProblemKind.UNLISTED, ProblemKind.LOST, ProblemKind.TWICE})
_SENTENCES = {
    ProblemKind.MISSING: "is gone since it was published",
    ProblemKind.EXTRA: "was not published with the asset",
    ProblemKind.ALTERED: "is not what was published (SHA-256)",
    ProblemKind.TWICE: f"lies in both {ASSETS} and {REJECTED}",
    ProblemKind.UNLISTED: "a folder without a row",
    ProblemKind.STALE: "its row is not what its folder says",
}


@dataclass(frozen=True)
class Problem:
    """One thing that is not as it was published.

    Attributes:
        id: of the asset.
        kind: of the fault.
        path: of the file or folder, within the registry.
        message: a sentence.
    """

    id: str
    kind: ProblemKind
    path: str
    message: str


class Settled(StrEnum):
    """What became of a damaged asset."""

    MENDED = "mended"
    """It is whole again."""
    WITHDRAWN = "withdrawn"
    """It is registered no more."""
    LEFT = "left"
    """It is as it was: there was no time to make it again."""


def verify(registry: Registry, ids: Iterable[str] | None = None) -> tuple[Problem, ...]:
    """Read every file again and compare it with its digest at publication.

    Others may use the registry meanwhile. All that has a row or a folder is read by default.

    Returns:
        Faults, by id. ``factory registry rebuild`` mends rows; a file that is not as
        published is built again.
    """
    wanted = known_ids(registry.root) if ids is None else sorted(set(ids))
    found = (_confirmed(registry, asset_id) for asset_id in wanted)
    return tuple(chain.from_iterable(found))


def _confirmed(registry: Registry, asset_id: str) -> list[Problem]:
    """Return an asset's faults that are found twice: it may be being published."""
    if not list(_problems(registry, asset_id)):
        return []
    still: AbstractContextManager[object] = nullcontext()
    if os.access(registry.root, os.W_OK):
        still = writing(registry.root)
    with still:
        return list(_problems(registry, asset_id))


def _problems(registry: Registry, asset_id: str) -> Iterator[Problem]:
    root = registry.root
    with connected(root) as connection:
        entry = rows.find(connection, "id", asset_id)
        digest = rows.report_digest(connection, asset_id)
    folders = folders_of(root, asset_id)
    folder = folders[0] if folders else root / ASSETS / asset_id
    where = folder.relative_to(root).as_posix()

    def problem(kind: ProblemKind, name: str = "", sentence: str = "") -> Problem:
        path = f"{where}/{name}" if name else where
        said = sentence or f"{path if name else asset_id}: {_SENTENCES[kind]}"
        return Problem(asset_id, kind, path, said)

    if not folders:
        if entry is not None:
            sentence = f"{asset_id}: listed as {entry.status}, without a folder"
            yield problem(ProblemKind.LOST, sentence=sentence)
        return
    if len(folders) > 1:
        yield problem(ProblemKind.TWICE)
    if entry is None:
        yield problem(ProblemKind.UNLISTED)
    try:
        stored = read_report(folder)
        registered = stored.files
        found = file_digests(folder)
    except (RegistryError, ValueError, OSError) as error:
        yield problem(ProblemKind.UNREADABLE, REPORT, str(error))
        return
    if digest and digest != stored.digest:
        yield problem(ProblemKind.ALTERED, REPORT)
    for name in sorted(registered.keys() | found.keys()):
        if registered.get(name) != found.get(name):
            there = ProblemKind.ALTERED if name in registered else ProblemKind.EXTRA
            yield problem(there if name in found else ProblemKind.MISSING, name)
    if entry is None:
        return
    try:
        told = read_record(folder).entry
    except RegistryError as error:
        yield problem(ProblemKind.UNREADABLE, REPORT, str(error))
        return
    if told != entry:
        yield problem(ProblemKind.STALE)


def mend_rows(registry: Registry, problems: Iterable[Problem]) -> None:
    """Bring rows in line with their folders, as far as they are concerned; no file is touched."""
    ids = sorted({problem.id for problem in problems if problem.kind in _OF_ROWS})
    if ids:
        write_rows(registry.root, ids)


def settle(
    registry: Registry, problems: Iterable[Problem], *, final: bool = True
) -> dict[str, Settled]:
    """Return what became of damaged assets, once all that can be made again was.

    Files added to a folder, and assets that still differ from those registered, are moved to
    ``withdrawn``: nobody takes them for assets any more, and nothing is lost.

    Unless all was tried, which ``final`` says, they are left as they are.

    Returns:
        By id, sorted.
    """
    ids = sorted({problem.id for problem in problems})
    return {asset_id: _settled(registry, asset_id, final) for asset_id in ids}


def _settled(registry: Registry, asset_id: str, final: bool) -> Settled:
    left = verify(registry, (asset_id,))
    if left and {problem.kind for problem in left} == {ProblemKind.EXTRA}:
        _set_extras_aside(registry, asset_id, left)
        left = verify(registry, (asset_id,))
    if not left:
        known = registry.find(asset_id) is not None
        return Settled.MENDED if known else Settled.WITHDRAWN
    if not final:
        return Settled.LEFT
    set_asset_aside(registry, asset_id, WITHDRAWN)
    return Settled.WITHDRAWN


def _set_extras_aside(registry: Registry, asset_id: str, extras: Sequence[Problem]) -> None:
    with writing(registry.root):
        for problem in extras:
            path = registry.root / problem.path
            # Somebody may have published it anew meanwhile.
            if os.path.lexists(path):
                set_aside(registry, path, Path(*path.relative_to(registry.root).parts[1:]))
