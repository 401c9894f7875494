"""What the folders say: the truth that rows are made from."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

from asset_factory.sim_checks import Status

from ..errors import RegistryError
from ..runtime.layout import ASSETS, REJECTED, REPORT
from .database import connected
from .entry import entry_from, is_id
from .notes import note_path, read_note
from .report_file import read_report
from .rows import RegistryRow


def all_ids(root: Path) -> list[str]:
    """Return the names of everything that has a folder, sorted."""
    found = set()
    for place in (ASSETS, REJECTED):
        if (root / place).is_dir():
            with os.scandir(root / place) as items:
                folders = (item for item in items if item.is_dir(follow_symlinks=False))
                found |= {folder.name for folder in folders if is_id(folder.name)}
    return sorted(found)


def known_ids(root: Path) -> list[str]:
    """Return the ids of everything that has a row or a folder, sorted."""
    with connected(root) as connection:
        listed = {str(row[0]) for row in connection.execute("SELECT id FROM assets")}
    return sorted(listed.union(all_ids(root)))


def folders_of(root: Path, asset_id: str) -> list[Path]:
    """Return where an asset lies: with those that passed, or with the others.

    It lies in both only if a process died between putting it in one and taking it out of the other:
    the newer is the first, and counts; in doubt the rejection.
    """
    places = (root / place / asset_id for place in (REJECTED, ASSETS))
    return sorted(filter(os.path.lexists, places), key=_written, reverse=True)


def read_record(folder: Path) -> RegistryRow:
    """Return the row of one asset's folder, in a registry or an export, with its note.

    Raises:
        RegistryError: its report cannot be read, or is of another asset or place.
    """
    stored = read_report(folder)
    try:
        files = stored.files
        noted = read_note(note_path(folder.parents[1], folder.name))
        entry = replace(entry_from(stored.entry), tags=noted.tags, solved=noted.solved_with(files))
        gpu_ready = stored.gpu_ready
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise RegistryError(f"{folder / REPORT}: {error}") from error
    if entry.id != folder.name:
        raise RegistryError(f"{folder / REPORT}: is of {entry.id!r}, not of its folder")
    if (entry.status is Status.PASSED) != (folder.parent.name == ASSETS):
        raise RegistryError(f"{folder}: is {entry.status}, which belongs in another folder")
    return RegistryRow(entry, stored.digest, gpu_ready)


def _written(folder: Path) -> int:
    try:
        return (folder / REPORT).stat().st_mtime_ns
    except OSError:
        return -1
