"""PLY, text and binary: polygons fanned from their first corner, texture kept, colours averaged.

Source: Greg Turk, The PLY Polygon File Format.
"""

from __future__ import annotations

import io
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from asset_factory.sim_checks.read.meshes import fan_polygons

from ...geometry.colors import linear_of
from ...geometry.soup import Soup
from ...mesh import FloatArray, IntArray, Material
from ..files import InputFiles
from ..images import read_texture
from ..limits import require_at_most, unreadable

_TYPES = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1",
    "short": "i2", "int16": "i2", "ushort": "u2", "uint16": "u2",
    "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4",
    "float": "f4", "float32": "f4", "double": "f8", "float64": "f8",
}  # fmt: skip
_MAX_HEADER_LINES = 1000


@dataclass
class PlyElement:
    """One announced table.

    Attributes:
        name: e.g. ``vertex``.
        count: rows.
        properties: name, type, and for a list the type of its length.
    """

    name: str
    count: int
    properties: list[tuple[str, str, str | None]] = field(default_factory=list)


@dataclass(frozen=True)
class PlyHeader:
    """What a file announces.

    Attributes:
        elements: in the order of the body.
        order: ``<`` or ``>``, ``None`` for text.
        texture: the image named by a ``TextureFile`` comment.
        start: where the body begins [bytes].
    """

    elements: list[PlyElement]
    order: str | None
    texture: str | None
    start: int


@dataclass
class PlyTable:
    """Values of one element: scalars per row, lists flattened with their lengths."""

    scalars: dict[str, npt.NDArray[Any]] = field(default_factory=dict)
    lists: dict[str, tuple[IntArray, npt.NDArray[Any]]] = field(default_factory=dict)


def _table(element: PlyElement, columns: list[list[Any]]) -> PlyTable:
    """Return columns that were read row by row: a property's numbers, or arrays of its lists."""
    table = PlyTable()
    for (name, _, length), values in zip(element.properties, columns, strict=True):
        if length is None:
            table.scalars[name] = np.array(values)
        else:
            sizes = np.array(list(map(len, values)), dtype=np.int64)
            table.lists[name] = (sizes, np.concatenate(values) if values else np.zeros(0))
    return table


def read_header(data: bytes, name: str) -> PlyHeader:
    """Return the header of a PLY file. Raises InputRejected: ``unreadable``."""
    stream = io.BytesIO(data)
    if stream.readline(16).strip() != b"ply":
        raise unreadable(name, "does not start with ply")
    elements: list[PlyElement] = []
    order: str | None = "?"
    texture: str | None = None
    for _ in range(_MAX_HEADER_LINES):
        raw = stream.readline(4096).decode("utf-8", "replace").strip()
        words = raw.split()
        if raw == "end_header":
            if order == "?":
                raise unreadable(name, "its header names no format")
            return PlyHeader(elements, order, texture, stream.tell())
        if words[:1] == ["format"]:
            order = {"ascii": None, "binary_little_endian": "<", "binary_big_endian": ">"}[words[1]]
        elif words[:1] == ["element"]:
            elements.append(PlyElement(words[1], int(words[2])))
        elif words[:2] == ["property", "list"]:
            elements[-1].properties.append((words[4], _TYPES[words[3]], _TYPES[words[2]]))
        elif words[:1] == ["property"]:
            elements[-1].properties.append((words[2], _TYPES[words[1]], None))
        elif words[:2] == ["comment", "TextureFile"]:
            texture = raw.split("TextureFile", 1)[1].strip()
    raise unreadable(name, "its header does not end")


def read_tables(data: bytes, header: PlyHeader, name: str) -> dict[str, PlyTable]:
    """Return tables by element name. Raises InputRejected, or whatever a broken body leads to."""
    if header.order is None:
        return _text(data[header.start :], header.elements, name)
    start = header.start
    tables: dict[str, PlyTable] = {}
    for element in header.elements:
        tables[element.name], start = _binary_table(data, start, element, header.order)
    return tables


def _text(body: bytes, elements: list[PlyElement], name: str) -> dict[str, PlyTable]:
    stream = io.BytesIO(body)
    tables: dict[str, PlyTable] = {}
    for element in elements:
        if element.count > len(body):
            announced = f"announces {element.count} entries of {element.name}"
            raise unreadable(name, f"{announced} in {len(body)} bytes")
        if not element.properties:
            continue
        rows = [stream.readline().split() for _ in range(element.count)]
        if element.count and not rows[-1] and element.properties:
            raise unreadable(name, f"ends before its {element.count} entries of {element.name}")
        tables[element.name] = _text_table(element, rows)
    return tables


def _text_table(element: PlyElement, rows: list[list[bytes]]) -> PlyTable:
    if all(length is None for _, _, length in element.properties):
        values = np.array(rows, dtype=np.float64).reshape(len(rows), -1)
        names = enumerate(name for name, _, _ in element.properties)
        return PlyTable({name: values[:, column] for column, name in names})
    columns: list[list[Any]] = [[] for _ in element.properties]
    for row in rows:
        at = 0
        for column, (_, _, length) in zip(columns, element.properties, strict=True):
            if length is None:
                column.append(float(row[at]))
                at += 1
                continue
            size = int(row[at])
            words = row[at + 1 : at + 1 + size]
            if size < 0 or len(words) != size:
                announced = f"a list of {element.name} announces {size} values"
                raise ValueError(f"{announced} and has {len(words)}")
            column.append(np.array([float(word) for word in words]))
            at += 1 + size
    return _table(element, columns)


def _binary_table(data: bytes, start: int, element: PlyElement, order: str) -> tuple[PlyTable, int]:
    """Return an element's values, and where the next starts; equal lists are read at once."""
    properties = [(f"{k}", kind, length) for k, (_, kind, length) in enumerate(element.properties)]
    first = PlyElement(element.name, 1 if element.count else 0, properties)
    lists = _binary_rows(data, start, first, order)[0].lists
    sizes = {key: int(lengths.sum()) for key, (lengths, _) in lists.items()}
    fields: list[tuple[Any, ...]] = []
    for key, kind, length in properties:
        if length is None:
            fields.append((key, order + kind))
        else:
            fields += [(f"{key}n", order + length), (key, order + kind, (sizes[key],))]
    dtype = np.dtype(fields)
    end = start + element.count * dtype.itemsize
    if end <= len(data):
        rows = np.frombuffer(data, dtype, element.count, start)
        if all((rows[f"{key}n"] == size).all() for key, size in sizes.items()):
            table = PlyTable()
            for k, (name, _, length) in enumerate(element.properties):
                if length is None:
                    table.scalars[name] = rows[f"{k}"]
                else:
                    table.lists[name] = (rows[f"{k}n"].astype(np.int64), rows[f"{k}"].reshape(-1))
            return table, end
    return _binary_rows(data, start, element, order)


def _binary_rows(data: bytes, start: int, element: PlyElement, order: str) -> tuple[PlyTable, int]:
    plan: list[tuple[list[Any], Any, Any]] = [
        ([], np.dtype(order + kind), None if length is None else np.dtype(order + length))
        for _, kind, length in element.properties
    ]
    for _ in range(element.count):
        for column, kind, length in plan:
            size = 1
            if length is not None:
                size = int(np.frombuffer(data, length, 1, start)[0])
                start += length.itemsize
                if not 0 <= size * kind.itemsize <= len(data) - start:
                    past = f"a list of {element.name} has {size} values, past the end of the file"
                    raise ValueError(past)
            values = np.frombuffer(data, kind, size, start) if size else np.zeros(0, kind)
            start += size * kind.itemsize
            column.append(values[0] if length is None else values)
    return _table(element, [column for column, _, _ in plan]), start


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
    most = _ENTRIES_PER_FACE * files.limits.max_faces
    require_at_most(f"{path.name}, all elements", entries, most, "entries")
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
    textured = _textured(header.texture, path, files, notes)
    material = textured or _coloured(vertex, face, triangles, notes)
    return Soup(
        corners=positions[triangles.vertices],
        uv=_uv(vertex, face, triangles),
        normals=_columns(vertex, ("nx", "ny", "nz"), triangles.vertices),
        face_material=np.zeros(len(triangles.vertices), dtype=np.int64),
        materials=(material,),
        notes=tuple(notes),
    )


def _triangles(face: PlyTable, vertex_count: int, name: str, max_faces: int) -> _Triangles:
    lists = face.lists.get("vertex_indices") or face.lists.get("vertex_index")
    lengths, flat = lists or (_NONE, _NONE)
    require_at_most(name, int(np.maximum(lengths - 2, 0).sum()), max_faces, "faces")
    slots = fan_polygons(lengths)
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
    encoded = partial(files.read_reference, name, path.parent)
    texture = read_texture(name, encoded, files, notes)
    return None if texture is None else Material("textured", (1.0, 1.0, 1.0, 1.0), texture)


def _coloured(
    vertex: PlyTable, face: PlyTable, triangles: _Triangles, notes: list[str]
) -> Material:
    used = np.unique(triangles.vertices)
    for table, rows in ((vertex, used), (face, np.arange(len(triangles.lengths)))):
        colors = _columns(table, _RGB, rows)
        if colors is not None and len(colors):
            full = 255.0 if colors.max() > 1.0 else 1.0
            linear = linear_of(np.clip(np.nan_to_num(colors / full), 0.0, 1.0))
            red, green, blue = (round(float(c), 6) for c in linear.mean(axis=0))
            notes.append("The colours of vertices or faces were averaged to one colour.")
            return Material("default", (red, green, blue, 1.0))
    return Material("default")
