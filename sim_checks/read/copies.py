"""Copies of a description's files in one folder, each in its place beside the others."""

from __future__ import annotations

import errno
import xml.etree.ElementTree as ET
from pathlib import Path
from urllib.parse import unquote

from ..description import DescriptionError
from .document import is_file
from .meshes import MAX_MESH_BYTES
from .references import named_in_mesh
from .regular import read_regular
from .roots import Roots

#: Of all files of one description together [bytes], and how many.
MOST_BYTES = 2 * 2**30
MOST_FILES = 20_000


class Copies:
    """Copies of files, each once, with what they name themselves.

    Args:
        folder: where they go.
        roots: what may be read.
    """

    def __init__(self, folder: Path, roots: Roots) -> None:
        folder.mkdir(parents=True)
        self.folder = folder
        self.roots = roots
        self._read: dict[Path, None] = {}
        self._copied: dict[Path, Path] = {}
        self._left = MOST_BYTES

    @property
    def originals(self) -> tuple[Path, ...]:
        """Return the files that were read, in the order of first use."""
        return tuple(self._read)

    def place(self, file: Path) -> Path:
        """Return where the copy of a file, by its resolved path, lies."""
        return self.folder / self.roots.copied_to(file)

    def take(self, file: Path) -> Path:
        """Copy a file and, of a mesh, its materials and pictures; returns the copy's place."""
        waiting = [file]
        while waiting:
            original = waiting.pop()
            if original in self._copied:
                continue
            data = self.read(original)
            place = self._copied[original] = self.place(original)
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_bytes(data)
            for name in named_in_mesh(original, data):
                beside = [original.parent / name, original.parent / unquote(name)]
                waiting += [p.resolve() for p in beside if self.roots.allows(p) and is_file(p)]
        return self._copied[file]

    def read(self, file: Path) -> bytes:
        """Return the content of a file, within what all may hold together.

        Raises:
            DescriptionError: ``too_large``, or ``unreadable_mesh``.
        """
        self._read[file] = None
        try:
            if len(self._read) > MOST_FILES:
                raise OSError(errno.EFBIG, f"is one of over {MOST_FILES} files")
            data = read_regular(file, min(MAX_MESH_BYTES, self._left))
        except OSError as error:
            code = "too_large" if error.errno == errno.EFBIG else "unreadable_mesh"
            raise DescriptionError(code, f"{file.name}: {error.strerror}") from error
        self._left -= len(data)
        return data

    def write(self, document: ET.Element, original: Path, place: Path) -> None:
        """Write a document, changed, in its place."""
        self._read[original] = None
        text: bytes = ET.tostring(document, encoding="utf-8")
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(text)
