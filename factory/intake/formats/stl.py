"""STL, binary and text. Facet normals are not kept: they repeat the winding."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from ...geometry.soup import Soup, plain_soup
from ..files import InputFiles
from ..limits import require_at_most, unreadable

_HEADER = 84
_FACET = 50
_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_VERTEX = re.compile(rb"vertex\s+(\S+)\s+(\S+)\s+(\S+)")


def read_stl(data: bytes, path: Path, files: InputFiles) -> Soup:
    """Return the triangles of an STL file, in the file's own frame and units.

    Raises:
        InputRejected: ``unreadable`` or ``too_large``.
    """
    if len(data) >= _HEADER:
        count = int.from_bytes(data[80:84], "little")
        fits = _HEADER + count * _FACET
        if fits <= len(data) and (fits == len(data) or not _is_text(data)):
            require_at_most(path.name, count, files.limits.max_faces, "faces")
            records = np.frombuffer(data, _RECORD, count, _HEADER)
            return plain_soup(records["corners"].astype(np.float64))
        if not _is_text(data):
            says = f"{count} facets as its header says take {fits}"
            raise unreadable(path.name, f"is {len(data)} bytes; {says}")
    if not _is_text(data):
        raise unreadable(path.name, f"is {len(data)} bytes and neither a text nor a binary STL")
    return _read_text(data, path.name, files.limits.max_faces)


def _is_text(data: bytes) -> bool:
    return data.lstrip()[:5].lower() == b"solid" and b"\0" not in data[:_HEADER].rstrip(b"\0 ")


def _read_text(data: bytes, name: str, max_faces: int) -> Soup:
    lower = data.lower()
    require_at_most(name, lower.count(b"vertex") // 3, max_faces, "faces")
    # Most of a text is between its triangles: cut off there, it would be a smaller mesh.
    if b"vertex" in lower.rpartition(b"endsolid")[2]:
        raise unreadable(name, "its last solid does not end; it may be cut off")
    numbers = [float(word) for match in _VERTEX.finditer(lower) for word in match.groups()]
    if len(numbers) % 9:
        odd = f"its {len(numbers) // 3} vertices do not make whole triangles"
        raise unreadable(name, f"{odd}; it may be cut off")
    return plain_soup(np.array(numbers, dtype=np.float64).reshape(-1, 3, 3))
