"""Whether a registry still is what was published: every file, every row."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from pathlib import Path

from ..errors import RegistryError
from ..runtime.layout import ASSETS, REJECTED, REPORT
from . import rows
from .database import connected, writing
from .entry import Entry
from .folders import all_ids, current_folder, read_record
from .notes import note_path
from .registry import Registry
from .report_file import file_digests, read_report


@dataclass(frozen=True)
class Problem:
    """One thing that is not as it was published.

    Attributes:
        id: of the asset.
        kind: ``missing``, ``altered`` or ``extra``: a file against its digest; ``lost``: a row
            without a folder; ``unlisted``: a folder without a row; ``stale``: a row that says
            something else than its folder; ``unreadable``: a report that is none; ``twice``: it
            lies among those that passed and among the others.
        path: of the file or folder, within the registry.
        message: a sentence.
    """

    id: str
    kind: str
    path: str
    message: str


def verify(registry: Registry, ids: Iterable[str] | None = None) -> tuple[Problem, ...]:
    """Read every file again and compare it with its digest at publication.

    Args:
        registry: others may use it meanwhile.
        ids: only these; by default everything that has a row or a folder.

    Returns:
        What is wrong, by id. ``factory registry rebuild`` mends rows; a file that is not as
        published is built again.
    """
    return tuple(
        problem for asset_id in _ids(registry, ids) for problem in _confirmed(registry, asset_id)
    )


def _ids(registry: Registry, ids: Iterable[str] | None) -> list[str]:
    if ids is not None:
        return sorted(set(ids))
    return sorted({entry.id for entry in registry.walk()} | set(all_ids(registry.root)))


def _confirmed(registry: Registry, asset_id: str) -> list[Problem]:
    """Return what is wrong with an asset when looked at twice: it may be being published."""
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
    folders = [
        folder
        for folder in (root / ASSETS / asset_id, root / REJECTED / asset_id)
        if folder.is_dir()
    ]
    folder = current_folder(root, asset_id)
    where = folder.relative_to(root).as_posix()
    if not folders:
        if entry is not None:
            yield Problem(
                asset_id, "lost", where, f"{asset_id}: listed as {entry.status}, without a folder"
            )
        return
    if len(folders) > 1:
        yield Problem(asset_id, "twice", where, f"{asset_id}: lies in both {ASSETS} and {REJECTED}")
    if entry is None:
        yield Problem(asset_id, "unlisted", where, f"{asset_id}: a folder without a row")
    yield from _problems_of_files(folder, where, digest)
    if entry is not None:
        yield from _problems_of_row(root, folder, where, entry)


def _problems_of_files(folder: Path, where: str, digest: str) -> Iterator[Problem]:
    asset_id = folder.name
    try:
        stored = read_report(folder)
        registered = stored.files
        found = file_digests(folder)
    except (RegistryError, ValueError, OSError) as error:
        yield Problem(asset_id, "unreadable", f"{where}/{REPORT}", str(error))
        return
    if digest and digest != stored.digest:
        yield _problem(asset_id, "altered", f"{where}/{REPORT}")
    for name in sorted(registered.keys() | found.keys()):
        if registered.get(name) != found.get(name):
            kind = (
                "missing" if name not in found else "extra" if name not in registered else "altered"
            )
            yield _problem(asset_id, kind, f"{where}/{name}")


def _problems_of_row(root: Path, folder: Path, where: str, entry: Entry) -> Iterator[Problem]:
    try:
        told = read_record(folder, note_path(root, entry.id)).entry
    except RegistryError as error:
        yield Problem(entry.id, "unreadable", f"{where}/{REPORT}", str(error))
        return
    if told != entry:
        yield Problem(entry.id, "stale", where, f"{entry.id}: its row is not what its folder says")


def _problem(asset_id: str, kind: str, path: str) -> Problem:
    sentence = {
        "missing": "is gone since it was published",
        "extra": "was not published with the asset",
        "altered": "is not what was published (SHA-256)",
    }
    return Problem(asset_id, kind, path, f"{path}: {sentence[kind]}")
