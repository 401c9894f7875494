"""A scene read back from a GLB of :mod:`.glb`; of nobody else's."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

from ..config import IntakeConfig
from ..errors import InputRejected
from ..intake.files import InputFiles
from ..intake.formats.gltf_document import GltfDocument
from .glb import HULLS, REPLACED, VISUALS, flipped
from .scene import SceneGraph, SceneJoint, SceneSurface

MAX_BYTES = 512 * 2**20
#: What a file of at most so many bytes may hold; it refers to no other files.
_LIMITS = replace(IntakeConfig(), max_bytes=MAX_BYTES, max_faces=MAX_BYTES)
_NO_FOLDER = Path(os.devnull)


def read_model(path: Path) -> bytes:
    """Return the bytes of such a file, which :func:`scene_from` reads.

    Raises:
        OSError: it cannot be read.
        ValueError: it holds no scene of ours. Whose program wrote it says nothing of that: other
            files of ours are plain meshes.
    """
    if path.is_symlink() or path.stat().st_size > MAX_BYTES:
        raise ValueError(f"{path.name}: want a file of at most {MAX_BYTES} bytes")
    data = path.read_bytes()
    scene_from(data)
    return data


def scene_from(data: bytes) -> SceneGraph:
    """Return the scene of such a file's bytes. Raises ValueError."""
    document = _document(data)
    try:
        extras = document.json["extras"]
        links = tuple(extras["links"])
        shown = [
            tuple(_surfaces(document, scene, len(links))) for scene in (VISUALS, HULLS, REPLACED)
        ]
        joints = tuple(SceneJoint(**told) for told in extras["joints"])
        return SceneGraph(extras["name"], links, joints, *shown)
    except (InputRejected, OSError, LookupError, TypeError, AttributeError) as error:
        raise ValueError(f"no scene of ours: {type(error).__name__}: {error}") from error


def _document(data: bytes) -> GltfDocument:
    if data[:4] != b"glTF":
        raise ValueError("no GLB file")
    try:
        return GltfDocument(data, _NO_FOLDER, InputFiles(_NO_FOLDER, _LIMITS))
    except (InputRejected, LookupError, TypeError, AttributeError) as error:
        raise ValueError(f"no GLB file: {error}") from error


def _surfaces(document: GltfDocument, which: int, links: int) -> Iterator[SceneSurface]:
    scenes = document.items("scenes")
    if which >= len(scenes):
        return
    # The nodes of a chain stand one after another behind their root, in the order of links.
    first = scenes[which]["nodes"][0] + 1
    for link in range(links):
        node = document.get("nodes", first + link)
        if "mesh" in node:
            for primitive in document.get("meshes", node["mesh"])["primitives"]:
                yield _surface(document, primitive, link)


def _surface(document: GltfDocument, primitive: dict[str, Any], link: int) -> SceneSurface:
    arrays = {name: document.accessor(at) for name, at in primitive["attributes"].items()}
    look = document.get("materials", primitive["material"])["pbrMetallicRoughness"]
    image = None
    if "baseColorTexture" in look:
        texture = document.get("textures", look["baseColorTexture"]["index"])
        image = document.image_bytes(texture["source"])
    uv = arrays.get("TEXCOORD_0")
    red, green, blue, alpha = (float(value) for value in look["baseColorFactor"])
    return SceneSurface(
        link,
        arrays["POSITION"],
        document.accessor(primitive["indices"]).reshape(-1, 3),
        arrays.get("NORMAL"),
        None if uv is None else flipped(uv),
        (red, green, blue, alpha),
        image,
    )
