"""A scene as one GLB file: what everybody's viewer opens, and what ours reads back.

The first glTF scene holds the visible surfaces, the second one the hulls, a third one those that
repairs replaced, if any; each on the same chain of links.
One animation opens and closes every joint. What glTF has no word for, such as limits, is in
``extras``.
"""

from __future__ import annotations

import os
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from ..config import IntakeConfig
from ..errors import InputRejected
from ..intake.files import InputFiles
from ..intake.formats.gltf_document import GltfDocument
from .gltf import MAGIC, Buffer
from .scene import FloatRows, SceneGraph, SceneJoint, SceneSurface

#: Key frames of the animation, and how long it takes [s].
KEYS = 25
SECONDS = 4.0
#: From z up to glTF's y up, as a quaternion x, y, z, w.
Z_UP = [-(0.5**0.5), 0.0, 0.0, 0.5**0.5]
VISUALS = 0
HULLS = 1
REPLACED = 2
MAX_BYTES = 512 * 2**20
#: What a stored model of at most so many bytes may hold; it refers to no other files.
_LIMITS = replace(IntakeConfig(), max_bytes=MAX_BYTES, max_faces=MAX_BYTES)
_NO_FOLDER = Path(os.devnull)


def glb_of(scene: SceneGraph) -> bytes:
    """Return the file's bytes: the same for the same scene."""
    writer = _Writer()
    shown = {"visuals": scene.visuals, "hulls": scene.hulls}
    if scene.replaced:
        shown["replaced"] = scene.replaced
    roots = [_chain(writer, scene, surfaces) for surfaces in shown.values()]
    document: dict[str, Any] = {
        "scene": VISUALS,
        "scenes": [{"name": n, "nodes": [root]} for n, (root, _) in zip(shown, roots, strict=True)],
        "nodes": writer.tables["nodes"],
        "extras": {
            "name": scene.name,
            "links": list(scene.links),
            "joints": [_told(j) for j in scene.joints],
        },
    }
    if scene.movable:
        document["animations"] = [_animation(writer, scene, [nodes for _, nodes in roots])]
    tables = ("meshes", "materials", "textures", "images")
    return writer.glb(document | {n: writer.tables[n] for n in tables if writer.tables[n]})


class _Writer(Buffer):
    """The arrays and tables of a file under way."""

    def __init__(self) -> None:
        super().__init__()
        self.tables: dict[str, list[dict[str, Any]]] = defaultdict(list)
        self._known: dict[object, int] = {}

    def add(self, table: str, entry: dict[str, Any]) -> int:
        """Append to a table; the number of the entry."""
        self.tables[table].append(entry)
        return len(self.tables[table]) - 1

    def material(self, surface: SceneSurface) -> int:
        """Return the material of a surface; equal ones once."""
        key = (surface.color, surface.image)
        if key not in self._known:
            look: dict[str, Any] = {
                "baseColorFactor": [round(float(value), 6) for value in surface.color],
                "metallicFactor": 0.0,
                "roughnessFactor": 0.8,
            }
            if surface.image is not None:
                look["baseColorTexture"] = {"index": self._texture(surface.image)}
            material = {"pbrMetallicRoughness": look, "doubleSided": True}
            if surface.color[3] < 0.999:
                material["alphaMode"] = "BLEND"
            self._known[key] = self.add("materials", material)
        return self._known[key]

    def _texture(self, image: bytes) -> int:
        if image not in self._known:
            kind = "image/png" if image.startswith(b"\x89PNG") else "image/jpeg"
            source = self.add("images", {"bufferView": self.view(image), "mimeType": kind})
            self._known[image] = self.add("textures", {"source": source})
        return self._known[image]

    def mesh(self, surfaces: list[SceneSurface]) -> int:
        """Return a mesh of one primitive per surface."""
        primitives = []
        for surface in surfaces:
            attributes = {"POSITION": self.vertices(surface.vertices)}
            if surface.normals is not None:
                attributes["NORMAL"] = self.vertices(surface.normals)
            if surface.uv is not None:
                # glTF counts from the top.
                attributes["TEXCOORD_0"] = self.vertices(flipped(surface.uv))
            width = np.uint16 if len(surface.vertices) < 2**16 - 1 else np.uint32
            indices = self.triangles(surface.faces.astype(width))
            made = {"attributes": attributes, "indices": indices}
            primitives.append({**made, "material": self.material(surface)})
        return self.add("meshes", {"primitives": primitives})


def _chain(
    writer: _Writer, scene: SceneGraph, surfaces: tuple[SceneSurface, ...]
) -> tuple[int, list[int]]:
    """Return the nodes of all links with those surfaces; the root's index, and each link's."""
    table = writer.tables["nodes"]
    root = writer.add("nodes", {"name": scene.name, "rotation": Z_UP, "children": [len(table) + 1]})
    nodes = []
    for number, name in enumerate(scene.links):
        own = [surface for surface in surfaces if surface.link == number and len(surface.faces)]
        node: dict[str, Any] = {"name": name}
        if own:
            node["mesh"] = writer.mesh(own)
        nodes.append(writer.add("nodes", node))
    for joint in scene.joints:
        table[nodes[joint.parent]].setdefault("children", []).append(nodes[joint.child])
        position, turn = _local(joint, 0.0)
        table[nodes[joint.child]] |= {"translation": position, "rotation": turn}
    return root, nodes


def _local(joint: SceneJoint, value: float) -> tuple[list[float], list[float]]:
    """Return the child frame in the parent's as a translation and a quaternion."""
    pose = joint.origin @ joint.motion(value)
    turn = Rotation.from_matrix(pose[:3, :3]).as_quat()
    return [round(float(x), 9) for x in pose[:3, 3]], [round(float(x), 9) for x in turn]


def _animation(writer: _Writer, scene: SceneGraph, chains: list[list[int]]) -> dict[str, Any]:
    """Return every joint from closed to open and back."""
    times = np.linspace(0.0, SECONDS, KEYS, dtype=np.float32)
    amounts = 1.0 - np.abs(2.0 * times / SECONDS - 1.0)
    values = [scene.completed(scene.opened(float(amount))) for amount in amounts]
    clock = writer.keys(times)
    samplers: list[dict[str, Any]] = []
    channels: list[dict[str, Any]] = []
    for joint in scene.movable:
        local = [_local(joint, at[joint.name]) for at in values]
        path = "translation" if joint.slides else "rotation"
        keys = np.array([pose[0 if joint.slides else 1] for pose in local], dtype=np.float32)
        samplers.append({"input": clock, "output": writer.keys(keys), "interpolation": "LINEAR"})
        for nodes in chains:
            target = {"node": nodes[joint.child], "path": path}
            channels.append({"sampler": len(samplers) - 1, "target": target})
    return {"name": "open and close", "channels": channels, "samplers": samplers}


def _told(joint: SceneJoint) -> dict[str, Any]:
    follows = ("leader", "multiplier", "offset")
    told = {k: value for k, value in vars(joint).items() if joint.leader or k not in follows}
    return {**told, "origin": joint.origin.tolist(), "axis": joint.axis.tolist()}


def flipped(uv: FloatRows) -> FloatRows:
    """Turn texture coordinates between counting from the bottom and, as glTF, from the top."""
    turned = uv.copy()
    turned[:, 1] = np.float32(1.0) - turned[:, 1]
    return turned


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
    if data[:4] != MAGIC:
        raise ValueError("no GLB file")
    try:
        document = GltfDocument(data, _NO_FOLDER, InputFiles(_NO_FOLDER, _LIMITS))
        extras = document.json["extras"]
        links = tuple(extras["links"])
        scenes = (VISUALS, HULLS, REPLACED)
        shown = [tuple(_surfaces(document, scene, len(links))) for scene in scenes]
        joints = tuple(SceneJoint(**told) for told in extras["joints"])
        return SceneGraph(extras["name"], links, joints, *shown)
    except (InputRejected, OSError, LookupError, TypeError, AttributeError) as error:
        raise ValueError(f"no scene of ours: {type(error).__name__}: {error}") from error


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
