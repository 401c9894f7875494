"""What every GLB is made of: the binary chunk, surfaces, materials, the container."""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np
import numpy.typing as npt

from ..geometry.rows import distinct_rows
from ..mesh import FloatArray, IntArray, Material, Mesh

#: Turns z up, front -Y into glTF's y up, front +Z.
Y_UP = np.array(
    [[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, -1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
)
#: Coordinates are written in steps of this many units, so that a last bit of rounding never shows.
DECIMALS = 6

GENERATOR = "asset-factory"
MAGIC = b"glTF"
JSON_CHUNK = 0x4E4F534A
BINARY_CHUNK = 0x004E4942
# Of glTF: component types, types by width, and targets of buffer views.
_COMPONENTS = {"float32": 5126, "uint32": 5125, "uint16": 5123}
_TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}
_VERTICES = 34962
_INDICES = 34963

Attribute = npt.NDArray[np.float32]


class Buffer:
    """The binary chunk of a GLB as it fills, and what the document says of it."""

    def __init__(self) -> None:
        self.data = bytearray()
        self.views: list[dict[str, int]] = []
        self.accessors: list[dict[str, Any]] = []

    def view(self, data: bytes, target: int | None = None) -> int:
        """Append bytes; the number of their view."""
        self._pad()
        place = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)}
        self.views.append(place if target is None else {**place, "target": target})
        self.data.extend(data)
        return len(self.views) - 1

    def vertices(self, rows: Attribute) -> int:
        """Append what vertices have, shape [vertex_count, 2 or 3]; the number of its accessor."""
        return self.array(rows, _VERTICES, bounds=rows.shape[1] == 3)

    def triangles(self, faces: npt.NDArray[Any]) -> int:
        """Append triangles, shape [face_count, 3]; the number of their accessor."""
        return self.array(faces.reshape(-1), _INDICES)

    def keys(self, rows: Attribute) -> int:
        """Append times [s], shape [key_count], or values then, shape [key_count, 3 or 4]."""
        return self.array(rows, bounds=rows.ndim == 1)

    def array(
        self, values: npt.NDArray[Any], target: int | None = None, *, bounds: bool = False
    ) -> int:
        """Append numbers, shape [count] or [count, width]; the number of their accessor."""
        entry = {
            "bufferView": self.view(np.ascontiguousarray(values).tobytes(), target),
            "componentType": _COMPONENTS[values.dtype.name],
            "count": len(values),
            "type": _TYPES[1 if values.ndim == 1 else values.shape[1]],
        }
        if bounds:
            rows = values.reshape(len(values), -1)
            entry |= {"min": rows.min(axis=0).tolist(), "max": rows.max(axis=0).tolist()}
        self.accessors.append(entry)
        return len(self.accessors) - 1

    def glb(self, document: dict[str, Any]) -> bytes:
        """Return the whole file: a document with this buffer."""
        self._pad()
        whole = {"asset": {"version": "2.0", "generator": GENERATOR}, **document}
        if self.data:
            whole |= {
                "accessors": self.accessors,
                "bufferViews": self.views,
                "buffers": [{"byteLength": len(self.data)}],
            }
        text = json.dumps(whole, separators=(",", ":"), allow_nan=False).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<II", len(text), JSON_CHUNK) + text
        if self.data:
            chunks += struct.pack("<II", len(self.data), BINARY_CHUNK) + self.data
        return struct.pack("<4sII", MAGIC, 2, 12 + len(chunks)) + chunks

    def _pad(self) -> None:
        """Pad to the next multiple of 4, as glTF wants it."""
        self.data.extend(b"\0" * (-len(self.data) % 4))


def primitive(
    buffer: Buffer, mesh: Mesh, faces: IntArray, normals: FloatArray | None = None
) -> dict[str, Any]:
    """Return some faces of one material, without that material.

    Args:
        buffer: takes the numbers.
        mesh: in the file's frame.
        faces: which, shape [n].
        normals: unit normals of the corners of all faces, shape [face_count, 3, 3].
    """
    corners = mesh.faces[faces].reshape(-1)
    uv = mesh.corner_uv
    if uv is not None and np.isnan(uv[faces]).any():
        uv = None
    told = [values for values in (uv, normals) if values is not None]
    flat = [np.round(values[faces].reshape(len(corners), -1), DECIMALS) + 0.0 for values in told]
    rows = np.column_stack([corners.astype(np.float64), *flat])
    first, compact = distinct_rows(rows)
    unique = rows[first]
    positions = np.round(mesh.vertices[unique[:, 0].astype(np.int64)], DECIMALS) + 0.0
    attributes = {"POSITION": buffer.vertices(positions.astype(np.float32))}
    if uv is not None:
        # glTF measures v from the top of the image.
        from_top = np.column_stack([unique[:, 1], 1.0 - unique[:, 2]])
        attributes["TEXCOORD_0"] = buffer.vertices(from_top.astype(np.float32))
    if normals is not None:
        attributes["NORMAL"] = buffer.vertices(unique[:, -3:].astype(np.float32))
    triangles = compact.reshape(-1, 3).astype(np.uint32)
    return {"attributes": attributes, "indices": buffer.triangles(triangles)}


def gltf_materials(
    buffer: Buffer, materials: tuple[Material, ...], images: tuple[bytes | None, ...]
) -> dict[str, Any]:
    """Return the document's entries for materials, each with its PNG if it has one.

    Colours are linear, as glTF wants them. Equal images are embedded once.
    """
    different = list(dict.fromkeys(image for image in images if image is not None))
    entries = []
    for material, image in zip(materials, images, strict=True):
        surface: dict[str, Any] = {
            "baseColorFactor": list(material.color),
            "metallicFactor": 0.0,
            "roughnessFactor": 0.7,
        }
        if image is not None:
            surface["baseColorTexture"] = {"index": different.index(image)}
        entries.append({"name": material.name, "pbrMetallicRoughness": surface})
    document: dict[str, Any] = {"materials": entries}
    if different:
        views = [buffer.view(image) for image in different]
        document["images"] = [{"bufferView": view, "mimeType": "image/png"} for view in views]
        document["textures"] = [{"source": i, "sampler": 0} for i in range(len(different))]
    return document
