"""A scene read back from a GLB of :mod:`.glb`; of nobody else's."""

from __future__ import annotations

import json
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from .glb import HULLS, REPLACED, VISUALS, flipped
from .gltf import BINARY_CHUNK, GENERATOR, JSON_CHUNK, MAGIC
from .scene import SceneGraph, SceneJoint, SceneSurface

MAX_BYTES = 512 * 2**20
_DTYPES: dict[int, np.dtype[Any]] = {
    5126: np.dtype("<f4"),
    5125: np.dtype("<u4"),
    5123: np.dtype("<u2"),
}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


def read_model(path: Path) -> bytes:
    """Return the bytes of such a file.

    Raises:
        OSError: it cannot be read.
        ValueError: it is not a GLB file of ours, by its first words.
    """
    if path.is_symlink() or path.stat().st_size > MAX_BYTES:
        raise ValueError(f"{path.name}: want a file of at most {MAX_BYTES} bytes")
    data = path.read_bytes()
    document, _ = _chunks(data)
    if document.get("asset", {}).get("generator") != GENERATOR:
        raise ValueError(f"{path.name}: is another program's")
    return data


def scene_from(data: bytes) -> SceneGraph:
    """Return the scene of such a file's bytes. Raises ValueError."""
    try:
        document, binary = _chunks(data)
        extras = document["extras"]
        joints = tuple(SceneJoint(**told) for told in extras["joints"])
        visuals = tuple(_surfaces(document, binary, VISUALS, len(extras["links"])))
        hulls = tuple(_surfaces(document, binary, HULLS, len(extras["links"])))
        replaced = tuple(_surfaces(document, binary, REPLACED, len(extras["links"])))
        return SceneGraph(extras["name"], tuple(extras["links"]), joints, visuals, hulls, replaced)
    except (KeyError, IndexError, TypeError, AttributeError, struct.error, RecursionError) as error:
        raise ValueError(f"no scene of ours: {type(error).__name__}: {error}") from error


def _chunks(data: bytes) -> tuple[dict[str, Any], bytes]:
    if data[:4] != MAGIC or len(data) < 20:
        raise ValueError("no GLB file")
    length, kind = struct.unpack_from("<II", data, 12)
    if kind != JSON_CHUNK:
        raise ValueError("a GLB file begins with JSON")
    document = json.loads(data[20 : 20 + length])
    if not isinstance(document, dict):
        raise ValueError("a GLB file begins with an object")
    rest = 20 + length
    if rest == len(data):
        return document, b""
    size, kind = struct.unpack_from("<II", data, rest)
    if kind != BINARY_CHUNK:
        raise ValueError("a GLB file ends with binary data")
    return document, data[rest + 8 : rest + 8 + size]


def _surfaces(
    document: dict[str, Any], binary: bytes, which: int, links: int
) -> Iterator[SceneSurface]:
    if which >= len(document["scenes"]):
        return
    # The nodes of a chain stand one after another behind their root, in the order of links.
    first = document["scenes"][which]["nodes"][0] + 1
    for link, node in enumerate(document["nodes"][first : first + links]):
        if "mesh" not in node:
            continue
        for primitive in document["meshes"][node["mesh"]]["primitives"]:
            yield _surface(document, binary, primitive, link)


def _surface(
    document: dict[str, Any], binary: bytes, primitive: dict[str, Any], link: int
) -> SceneSurface:
    names = primitive["attributes"]

    def array(name: str) -> npt.NDArray[Any] | None:
        return _array(document, binary, names[name]) if name in names else None

    look = document["materials"][primitive["material"]]["pbrMetallicRoughness"]
    image = None
    if "baseColorTexture" in look:
        texture = document["textures"][look["baseColorTexture"]["index"]]
        image = _view(document, binary, document["images"][texture["source"]]["bufferView"])
    uv = array("TEXCOORD_0")
    red, green, blue, alpha = (float(value) for value in look["baseColorFactor"])
    return SceneSurface(
        link,
        _array(document, binary, names["POSITION"]),
        _array(document, binary, primitive["indices"]).reshape(-1, 3),
        array("NORMAL"),
        None if uv is None else flipped(uv),
        (red, green, blue, alpha),
        image,
    )


def _array(document: dict[str, Any], binary: bytes, index: int) -> npt.NDArray[Any]:
    accessor = document["accessors"][index]
    dtype = _DTYPES[accessor["componentType"]]
    width = _WIDTHS[accessor["type"]]
    values: npt.NDArray[Any] = np.frombuffer(_view(document, binary, accessor["bufferView"]), dtype)
    return values.reshape(-1, width) if width > 1 else values


def _view(document: dict[str, Any], binary: bytes, index: int) -> bytes:
    view = document["bufferViews"][index]
    start = view["byteOffset"]
    return binary[start : start + view["byteLength"]]
