"""PLY, text and binary: polygons fanned from their first corner, texture kept, colours averaged."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...geometry.colors import linear_of
from ...geometry.soup import Soup
from ...mesh import FloatArray, IntArray, Material
from ..files import InputFiles
from ..images import load_texture
from ..limits import require_at_most, unreadable
from .ply_tables import PlyTable, read_header, read_tables

_COORDINATES = (("s", "t"), ("u", "v"), ("texture_u", "texture_v"))
_RGB = ("red", "green", "blue")
#: Vertices, faces, and what else a scanner writes.
_ENTRIES_PER_FACE = 6
_NONE: IntArray = np.zeros(0, dtype=np.int64)


@dataclass(frozen=True)
class _Triangles:
    """Triangles of fanned polygons.

    Attributes:
        vertices: of each triangle, shape [n, 3].
        slots: their places in the flat list of polygon corners, shape [n, 3].
        lengths: corners of each polygon.
    """

    vertices: IntArray
    slots: IntArray
    lengths: IntArray


def read_ply(data: bytes, path: Path, files: InputFiles) -> Soup:
    """Return the triangles of a PLY file, in the file's own frame and units.

    Raises:
        InputRejected: ``unreadable``, ``too_large``, or ``external_reference`` for its texture.
    """
    header = read_header(data, path.name)
    entries = sum(max(element.count, 0) for element in header.elements)
    require_at_most(
        f"{path.name}, all elements", entries, _ENTRIES_PER_FACE * files.limits.max_faces, "entries"
    )
    for element in header.elements:
        limit = files.limits.max_faces * (1 if element.name == "face" else 3)
        require_at_most(f"{path.name}, element {element.name}", element.count, limit, "entries")
    tables = read_tables(data, header, path.name)
    vertex = tables.get("vertex", PlyTable())
    face = tables.get("face", PlyTable())
    if not all(axis in vertex.scalars for axis in "xyz"):
        raise unreadable(path.name, "its vertices lack x, y or z")
    positions = np.stack([vertex.scalars[axis].astype(np.float64) for axis in "xyz"], axis=1)
    triangles = _triangles(face, len(positions), path.name, files.limits.max_faces)
    notes: list[str] = []
    material = _textured(header.texture, path, files, notes) or _coloured(
        vertex, face, triangles, notes
    )
    return Soup(
        corners=positions[triangles.vertices],
        uv=_uv(vertex, face, triangles),
        normals=_columns(vertex, ("nx", "ny", "nz"), triangles.vertices),
        face_material=np.zeros(len(triangles.vertices), dtype=np.int64),
        materials=(material,),
        notes=tuple(notes),
    )


def _triangles(face: PlyTable, vertex_count: int, name: str, max_faces: int) -> _Triangles:
    lengths, flat = (
        face.lists.get("vertex_indices") or face.lists.get("vertex_index") or (_NONE, _NONE)
    )
    counts = np.maximum(lengths - 2, 0)
    require_at_most(name, int(counts.sum()), max_faces, "faces")
    polygon = np.repeat(np.arange(len(lengths)), counts)
    step = np.arange(len(polygon)) - np.repeat(np.cumsum(counts) - counts, counts)
    base = (np.cumsum(lengths) - lengths)[polygon]
    slots = np.stack([base, base + step + 1, base + step + 2], axis=1)
    vertices = flat.astype(np.int64)[slots]
    if len(vertices) and not 0 <= vertices.min() <= vertices.max() < vertex_count:
        raise unreadable(name, f"a face uses a vertex outside 0..{vertex_count - 1}")
    return _Triangles(vertices, slots, lengths)


def _columns(table: PlyTable, names: tuple[str, ...], rows: IntArray) -> FloatArray | None:
    if not all(name in table.scalars for name in names):
        return None
    return np.asarray(np.stack([table.scalars[n].astype(np.float64) for n in names], axis=1)[rows])


def _uv(vertex: PlyTable, face: PlyTable, triangles: _Triangles) -> FloatArray | None:
    if "texcoord" in face.lists:
        sizes, flat = face.lists["texcoord"]
        if (sizes == 2 * triangles.lengths).all():
            return np.asarray(flat.astype(np.float64).reshape(-1, 2)[triangles.slots])
    for names in _COORDINATES:
        found = _columns(vertex, names, triangles.vertices)
        if found is not None:
            return found
    return None


def _textured(name: str | None, path: Path, files: InputFiles, notes: list[str]) -> Material | None:
    if not name:
        return None
    try:
        texture = load_texture(files.read_reference(name, path.parent), name, files)
    except FileNotFoundError:
        texture = None
    if texture is None:
        notes.append(f"The texture {name} is missing or broken; a plain colour was used.")
        return None
    return Material("textured", (1.0, 1.0, 1.0, 1.0), texture)


def _coloured(
    vertex: PlyTable, face: PlyTable, triangles: _Triangles, notes: list[str]
) -> Material:
    used = np.unique(triangles.vertices)
    for table, rows in ((vertex, used), (face, np.arange(len(triangles.lengths)))):
        colors = _columns(table, _RGB, rows)
        if colors is not None and len(colors):
            full = 255.0 if colors.max() > 1.0 else 1.0
            red, green, blue = (round(float(c), 6) for c in _linear(colors / full).mean(axis=0))
            notes.append("The colours of vertices or faces were averaged to one colour.")
            return Material("default", (red, green, blue, 1.0))
    return Material("default")


def _linear(srgb: FloatArray) -> FloatArray:
    return linear_of(np.clip(np.nan_to_num(srgb), 0.0, 1.0))
