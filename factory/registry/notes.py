"""Notes on a registered asset: tags, and whether a robot opened it.

It lies beside the assets, one file each, because an asset's own folder never changes.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..errors import RegistryError
from ..runtime.layout import NOTES
from ..runtime.store import digest_bytes, write_json
from .entry import SOLVED, require_tags

_MAX_BYTES = 1_000_000
_UNREADABLE = (
    *(OSError, RegistryError, RecursionError),
    *(ValueError, KeyError, TypeError, AttributeError),
)


@dataclass(frozen=True)
class Note:
    """One asset's note.

    Attributes:
        tags: sorted.
        solved: ``yes``, ``no`` or empty.
        solved_files: :func:`fingerprint` of the files that the robot was given; others have not
            been tried.
    """

    tags: tuple[str, ...] = ()
    solved: str = ""
    solved_files: str = ""

    def solved_with(self, files: dict[str, str]) -> str:
        """Return ``solved``, if it was found with these files."""
        return self.solved if self.solved and self.solved_files == fingerprint(files) else ""


def fingerprint(files: dict[str, str]) -> str:
    """Return one digest for all files of an asset, from their own."""
    return digest_bytes(json.dumps(files, sort_keys=True).encode())


def note_path(root: Path, asset_id: str) -> Path:
    """Return where an asset's note lies."""
    return root / NOTES / f"{asset_id}.json"


def read_note(path: Path) -> Note:
    """Read a note; an empty one if there is none or it is unreadable."""
    try:
        if path.stat().st_size > _MAX_BYTES:
            return Note()
        data: dict[str, Any] = json.loads(path.read_bytes())
        tags = tuple(sorted({str(tag) for tag in data["tags"]}))
        note = Note(tags, str(data.get("solved", "")), str(data.get("solved_files", "")))
        require_tags(note.tags)
    except _UNREADABLE:
        return Note()
    return note if note.solved in SOLVED else Note(note.tags)


def write_note(path: Path, note: Note) -> None:
    """Write a note, or remove it if it says nothing."""
    if note == Note():
        path.unlink(missing_ok=True)
        return
    path.parent.mkdir(exist_ok=True)
    data = {"tags": list(note.tags), "solved": note.solved, "solved_files": note.solved_files}
    write_json(path, data, lasting=True)
