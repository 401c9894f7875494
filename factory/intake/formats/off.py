"""OFF and its coloured kin: text only, polygons fanned from their first corner, colours ignored."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ...errors import InputRejected
from ...geometry.soup import Soup, plain_soup
from ..files import InputFiles
from ..limits import require_at_most, unreadable

#: Three coordinates for up to three vertices, four indices, and some blanks to spare.
_WORDS_PER_FACE = 16


def read_off(data: bytes, path: Path, files: InputFiles) -> Soup:
    """Return the triangles of an OFF file, in the file's own frame and units.

    Raises:
        InputRejected: ``unreadable``, ``unsupported`` (binary, four-dimensional) or ``too_large``.
    """
    name = path.name
    max_faces = files.limits.max_faces
    words = sum(data.count(blank) for blank in (b" ", b"\t", b"\n"))
    require_at_most(name, words, _WORDS_PER_FACE * max_faces, "words")
    rows = [row for row in (line.split(b"#")[0].split() for line in data.splitlines()) if row]
    if not rows or not rows[0][0].endswith(b"OFF"):
        raise unreadable(name, "does not start with OFF")
    if b"4" in rows[0][0] or b"BINARY" in rows[0]:
        kind = rows[0][0].decode("ascii", "replace")
        raise InputRejected("unsupported", f"{name} must be plain text OFF, not {kind}")
    header = rows[0][1:] or (rows[1] if len(rows) > 1 else [])
    body = rows[1:] if rows[0][1:] else rows[2:]
    vertex_count, face_count = (int(word) for word in header[:2])
    if min(vertex_count, face_count) < 0 or vertex_count + face_count > len(body):
        announced = f"announces {vertex_count} vertices and {face_count} faces"
        raise unreadable(name, f"{announced}, but has {len(body)} lines")
    require_at_most(name, face_count, max_faces, "faces")
    vertices = np.array([row[:3] for row in body[:vertex_count]], dtype=np.float64).reshape(-1, 3)
    triangles: list[tuple[int, int, int]] = []
    for row in body[vertex_count : vertex_count + face_count]:
        size = int(row[0])
        require_at_most(name, len(triangles) + size - 2, max_faces, "faces")
        polygon = [int(word) for word in row[1 : size + 1]]
        if len(polygon) != size:
            raise unreadable(name, f"a face announces {size} corners and lists {len(polygon)}")
        triangles.extend((polygon[0], polygon[k], polygon[k + 1]) for k in range(1, size - 1))
    faces = np.array(triangles, dtype=np.int64).reshape(-1, 3)
    if len(faces) and not 0 <= faces.min() <= faces.max() < vertex_count:
        raise unreadable(name, f"a face uses a vertex outside 0..{vertex_count - 1}")
    return plain_soup(vertices[faces])
