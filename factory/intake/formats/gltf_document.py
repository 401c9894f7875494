"""The container of a glTF 2.0 asset: JSON, buffers and typed accessors.

Source: Khronos glTF 2.0 specification, chapters "GLB File Format Specification" and "Binary Data
    Storage".
"""

from __future__ import annotations

import base64
import json
import struct
from pathlib import Path
from typing import Any
from urllib.parse import unquote, unquote_to_bytes

import numpy as np
import numpy.typing as npt

from ...errors import InputRejected
from ..files import InputFiles
from ..limits import require_at_most, unreadable

_JSON_CHUNK = 0x4E4F534A
_BIN_CHUNK = 0x004E4942
_MAX_JSON_VALUES = 4_000_000
#: Three positions, three normals, two coordinates, four colours at three corners of each face, and
#: some to spare.
_NUMBERS_PER_FACE = 64
_COMPONENTS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
_UNSUPPORTED = {
    "KHR_draco_mesh_compression": "Draco compression",
    "EXT_meshopt_compression": "meshopt compression",
    "KHR_meshopt_compression": "meshopt compression",
    "EXT_mesh_gpu_instancing": "GPU instancing",
}


class GltfDocument:
    """A parsed glTF JSON with access to its binary data.

    Args:
        path: where it came from; references are relative to its folder.

    Raises:
        InputRejected: ``unreadable``, ``unsupported``, ``too_large`` or ``external_reference``.
    """

    def __init__(self, data: bytes, path: Path, files: InputFiles) -> None:
        self.name = path.name
        self.files = files
        self.notes: list[str] = []
        self._folder = path.parent
        if data[:4] == b"glTF":
            text, self._glb_chunk = _split_glb(data, self.name)
        else:
            text = _as_json(data, self.name)
            self._glb_chunk = None
        values = sum(text.count(c) for c in (b",", b"[", b"{"))
        require_at_most(f"{self.name}, its JSON", values, _MAX_JSON_VALUES, "values")
        parsed = _parsed(text, self.name)
        if not isinstance(parsed, dict):
            raise unreadable(self.name, f"its JSON is a {type(parsed).__name__}, want an object")
        self.json: dict[str, Any] = parsed
        version = str(self.json.get("asset", {}).get("version", "2.0"))
        if not version.startswith("2"):
            old = f"{self.name}: is glTF {version[:20]}, want 2.0; convert it first"
            raise InputRejected("unsupported", old)
        for extension in self.json.get("extensionsRequired", []):
            if extension in _UNSUPPORTED:
                raise _unsupported(self.name, extension)
        self._buffers: dict[int, bytes] = {}
        self._accessors: dict[int, npt.NDArray[Any]] = {}
        self._numbers = 0

    def items(self, key: str) -> list[dict[str, Any]]:
        """Return a top-level array of the document, empty if absent."""
        value = self.json.get(key, [])
        return value if isinstance(value, list) else []

    def get(self, key: str, index: int) -> dict[str, Any]:
        """Return an entry of a top-level array. Raises InputRejected ``unreadable`` naming it."""
        entries = self.items(key)
        if not isinstance(index, int) or not 0 <= index < len(entries):
            raise unreadable(self.name, f"refers to {key}[{index}], but there are {len(entries)}")
        return entries[index]

    def uri_bytes(self, uri: str) -> bytes:
        """Return the content behind a URI: inline data, or a file in the asset's folder."""
        if uri[:5].lower() == "data:":
            header, _, payload = uri.partition(",")
            plain = not header.endswith(";base64")
            return unquote_to_bytes(payload) if plain else base64.b64decode(payload)
        return self.files.read_reference(unquote(uri), self._folder)

    def view_bytes(self, index: int) -> tuple[bytes, int, int, int]:
        """Return buffer, offset, length and stride (0: tightly packed) of one buffer view."""
        view = self.get("bufferViews", index)
        if "EXT_meshopt_compression" in view.get("extensions", {}):
            raise _unsupported(self.name, "EXT_meshopt_compression")
        data = self._buffer(view["buffer"])
        offset = int(view.get("byteOffset", 0))
        length = int(view["byteLength"])
        if offset < 0 or length < 0 or offset + length > len(data):
            end = f"ends at byte {offset + length}, its buffer has {len(data)}"
            raise unreadable(self.name, f"bufferViews[{index}] {end}")
        return data, offset, length, int(view.get("byteStride", 0))

    def image_bytes(self, index: int) -> bytes:
        """Return an image as it is encoded. Raises FileNotFoundError if its file is missing."""
        image = self.get("images", index)
        if "uri" in image:
            return self.uri_bytes(str(image["uri"]))
        data, offset, length, _ = self.view_bytes(image["bufferView"])
        return data[offset : offset + length]

    def accessor(self, index: int) -> npt.NDArray[Any]:
        """Return an accessor's elements, [count, width]; normalised integers become floats."""
        if index not in self._accessors:
            self._accessors[index] = self._read_accessor(index)
        return self._accessors[index]

    def _read_accessor(self, index: int) -> npt.NDArray[Any]:
        spec = self.get("accessors", index)
        count = int(spec["count"])
        if count < 0:
            raise unreadable(self.name, f"accessors[{index}] has count {count}")
        # Too many are refused before anything is allocated.
        most = 3 * self.files.limits.max_faces
        require_at_most(f"{self.name}, accessors[{index}]", count, most, "elements")
        width = _WIDTHS[spec["type"]]
        self._numbers += count * width
        limit = _NUMBERS_PER_FACE * self.files.limits.max_faces
        require_at_most(f"{self.name}, accessors up to {index}", self._numbers, limit, "numbers")
        dtype = np.dtype(_COMPONENTS[spec["componentType"]])
        if "bufferView" in spec:
            values = self._strided(spec, count, width, dtype)
        else:
            values = np.zeros((count, width), dtype=dtype)
        if "sparse" in spec:
            values = self._with_sparse(values, spec["sparse"], width, dtype)
        if spec.get("normalized", False) and dtype.kind in "iu":
            return np.maximum(values.astype(np.float64) / np.iinfo(dtype).max, -1.0)
        return values

    def _strided(
        self, spec: dict[str, Any], count: int, width: int, dtype: np.dtype[Any]
    ) -> npt.NDArray[Any]:
        view = spec["bufferView"]
        start = int(spec.get("byteOffset", 0))
        data, offset, length, stride = self.view_bytes(view)
        element = width * dtype.itemsize
        step = stride or element
        if start < 0 or step < 1 or (count and start + (count - 1) * step + element > length):
            fits = f"does not fit bufferViews[{view}], {length} bytes"
            raise unreadable(self.name, f"an accessor of {count} elements {fits}")
        strides = (step, dtype.itemsize)
        return np.ndarray((count, width), dtype, data, offset + start, strides).copy()

    def _with_sparse(
        self, values: npt.NDArray[Any], sparse: dict[str, Any], width: int, dtype: np.dtype[Any]
    ) -> npt.NDArray[Any]:
        count = int(sparse["count"])
        where = sparse["indices"]
        index_type = np.dtype(_COMPONENTS[where["componentType"]])
        indices = self._strided(where, count, 1, index_type)
        replacement = self._strided(sparse["values"], count, width, dtype)
        values[indices.reshape(-1).astype(np.int64)] = replacement
        return values

    def _buffer(self, index: int) -> bytes:
        if index not in self._buffers:
            spec = self.get("buffers", index)
            size = int(spec["byteLength"])
            most = self.files.limits.max_bytes
            require_at_most(f"{self.name}, buffers[{index}]", size, most, "bytes")
            self._buffers[index] = self._load_buffer(spec, index)
            found = len(self._buffers[index])
            if found < size:
                short = f"buffers[{index}] has {found} bytes, its header says {size}"
                raise unreadable(self.name, short)
        return self._buffers[index]

    def _load_buffer(self, spec: dict[str, Any], index: int) -> bytes:
        if "uri" not in spec:
            if self._glb_chunk is None or index != 0:
                nowhere = f"buffers[{index}] has neither a URI nor a binary chunk"
                raise unreadable(self.name, nowhere)
            return self._glb_chunk
        try:
            return self.uri_bytes(str(spec["uri"]))
        except FileNotFoundError as error:
            missing = f"its buffer {str(spec['uri'])[:80]!r} is missing"
            raise unreadable(self.name, missing) from error


def _as_json(data: bytes, name: str) -> bytes:
    """Return bytes without a GLB header, if JSON; else raise InputRejected ``unreadable``."""
    if data.lstrip(b"\xef\xbb\xbf \t\r\n")[:1] != b"{":
        begins = " ".join(f"{byte:02x}" for byte in data[:4])
        want = f"begins with {begins}, want 'glTF' (a binary GLB) or '{{' (JSON)"
        raise unreadable(name, f"{want}: damaged, compressed, or another kind of file")
    return data


def _parsed(text: bytes, name: str) -> Any:
    try:
        return json.loads(text.decode("utf-8-sig"))
    except (UnicodeDecodeError, json.JSONDecodeError) as error:
        where = error.start if isinstance(error, UnicodeDecodeError) else error.pos
        damaged = f"its JSON is damaged at byte {where} of {len(text)}; want glTF 2.0"
        raise unreadable(name, damaged) from error


def _split_glb(data: bytes, name: str) -> tuple[bytes, bytes | None]:
    if len(data) < 20:
        raise unreadable(name, f"is {len(data)} bytes, shorter than a GLB header")
    _, version, length = struct.unpack_from("<III", data)
    if version != 2:
        old = f"{name}: is binary glTF version {version}, want 2; convert it first"
        raise InputRejected("unsupported", old)
    if length > len(data):
        raise unreadable(name, f"is cut off: {len(data)} of {length} bytes")
    json_chunk = None
    binary = None
    offset = 12
    while offset + 8 <= length:
        size, kind = struct.unpack_from("<II", data, offset)
        if offset + 8 + size > length:
            raise unreadable(name, f"a chunk of {size} bytes reaches past the end of the file")
        chunk = data[offset + 8 : offset + 8 + size]
        if kind == _JSON_CHUNK and json_chunk is None:
            json_chunk = chunk
        elif kind == _BIN_CHUNK and binary is None:
            binary = chunk
        offset += 8 + size
    if json_chunk is None:
        raise unreadable(name, "has no JSON chunk")
    return json_chunk, binary


def _unsupported(name: str, extension: str) -> InputRejected:
    uses = f"{name}: uses {_UNSUPPORTED[extension]} ({extension})"
    return InputRejected("unsupported", f"{uses}, which is not read; export it without")
