"""The tables in a PLY file, text and binary of either endianness; what they mean is read elsewhere.

Source: Greg Turk, The PLY Polygon File Format.
"""

import io
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from ...mesh import IntArray
from ..limits import unreadable

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


def read_header(data: bytes, name: str) -> PlyHeader:
    """Return the header of a PLY file.

    Raises:
        InputRejected: ``unreadable``.
    """
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
            raise unreadable(
                name, f"announces {element.count} entries of {element.name} in {len(body)} bytes"
            )
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
        return PlyTable(
            scalars={name: values[:, k] for k, (name, _, _) in enumerate(element.properties)}
        )
    scalars: dict[str, list[float]] = {
        name: [] for name, _, length in element.properties if length is None
    }
    lists: dict[str, tuple[list[int], list[float]]] = {
        n: ([], []) for n, _, length in element.properties if length
    }
    for row in rows:
        at = 0
        for name, _, length in element.properties:
            if length is None:
                scalars[name].append(float(row[at]))
                at += 1
                continue
            size = int(row[at])
            words = row[at + 1 : at + 1 + size]
            if size < 0 or len(words) != size:
                raise ValueError(
                    f"a list of {element.name} announces {size} values and has {len(words)}"
                )
            lists[name][0].append(size)
            lists[name][1].extend(float(word) for word in words)
            at += 1 + size
    return PlyTable(
        {name: np.array(values) for name, values in scalars.items()},
        {
            n: (np.array(sizes, dtype=np.int64), np.array(values))
            for n, (sizes, values) in lists.items()
        },
    )


def _binary_table(data: bytes, start: int, element: PlyElement, order: str) -> tuple[PlyTable, int]:
    """Return an element's values, and where the next starts; equal lists are read at once."""
    sizes = [0 if length is None else -1 for _, _, length in element.properties]
    if element.count:
        sizes = _first_sizes(data, start, element, order)
    fields: list[tuple[Any, ...]] = []
    for k, (_, kind, length) in enumerate(element.properties):
        if length is None:
            fields.append((f"{k}", order + kind))
        else:
            fields += [(f"{k}n", order + length), (f"{k}", order + kind, (max(sizes[k], 0),))]
    dtype = np.dtype(fields)
    if len(data) - start >= element.count * dtype.itemsize:
        rows = np.frombuffer(data, dtype, element.count, start)
        uniform = all(
            (rows[f"{k}n"] == sizes[k]).all()
            for k, (_, _, length) in enumerate(element.properties)
            if length
        )
        if uniform:
            table = PlyTable()
            for k, (name, _, length) in enumerate(element.properties):
                if length is None:
                    table.scalars[name] = rows[f"{k}"]
                else:
                    table.lists[name] = (rows[f"{k}n"].astype(np.int64), rows[f"{k}"].reshape(-1))
            return table, start + element.count * dtype.itemsize
    return _binary_rows(data, start, element, order)


def _first_sizes(data: bytes, start: int, element: PlyElement, order: str) -> list[int]:
    sizes: list[int] = []
    for _, kind, length in element.properties:
        if length is None:
            sizes.append(0)
            start += np.dtype(kind).itemsize
            continue
        size = int(np.frombuffer(data, order + length, 1, start)[0])
        sizes.append(size)
        start += np.dtype(length).itemsize + size * np.dtype(kind).itemsize
        if size < 0 or start > len(data):
            raise ValueError(
                f"a list of {element.name} has {size} values, past the end of the file"
            )
    return sizes


def _binary_rows(data: bytes, start: int, element: PlyElement, order: str) -> tuple[PlyTable, int]:
    scalars: dict[str, list[Any]] = {
        name: [] for name, _, length in element.properties if length is None
    }
    lists: dict[str, tuple[list[int], list[Any]]] = {
        n: ([], []) for n, _, length in element.properties if length
    }
    plan = [
        (name, np.dtype(order + kind), None if length is None else np.dtype(order + length))
        for name, kind, length in element.properties
    ]
    for _ in range(element.count):
        for name, kind, length in plan:
            size = 1
            if length is not None:
                size = int(np.frombuffer(data, length, 1, start)[0])
                start += length.itemsize
                lists[name][0].append(size)
            values = np.frombuffer(data, kind, size, start) if size > 0 else np.zeros(0, kind)
            start += max(size, 0) * kind.itemsize
            (scalars[name].append(values[0]) if length is None else lists[name][1].append(values))
    return (
        PlyTable(
            {name: np.array(values) for name, values in scalars.items()},
            {
                n: (
                    np.array(sizes, dtype=np.int64),
                    np.concatenate(values) if values else np.zeros(0),
                )
                for n, (sizes, values) in lists.items()
            },
        ),
        start,
    )
