"""Notes on a registered asset: tags, and whether a robot opened it.

It lies beside the assets, one file each, because an asset's own folder never changes.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Annotated

import msgspec

from ..runtime.layout import NOTES
from ..runtime.store import digest_bytes, write_json
from .entry import TAG, Solved

_MAX_BYTES = 1_000_000


@dataclass(frozen=True)
class Note:
    """One asset's note.

    Attributes:
        tags: sorted.
        solved: ``yes``, ``no`` or empty.
        solved_files: :func:`fingerprint` of the files that the robot was given; others have not
            been tried.
    """

    tags: tuple[Annotated[str, msgspec.Meta(pattern=TAG)], ...] = ()
    solved: Solved = ""
    solved_files: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "tags", tuple(sorted(set(self.tags))))

    def solved_with(self, files: dict[str, str]) -> Solved:
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
        return msgspec.json.decode(path.read_bytes(), type=Note)
    except (OSError, ValueError, RecursionError):
        return Note()


def write_note(path: Path, note: Note) -> None:
    """Write a note, or remove it if it says nothing."""
    if note == Note():
        path.unlink(missing_ok=True)
        return
    path.parent.mkdir(exist_ok=True)
    write_json(path, asdict(note), lasting=True)
