"""COLLADA, as robot descriptions use it; needs ``pycollada``.

Lengths are brought to metres by the file's own unit, as robot tools do; its up axis is left alone.
"""

from __future__ import annotations

import io
import re
from dataclasses import replace
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from asset_factory.sim_checks.read.document import refuse_doctype

from ...errors import InputRejected
from ...geometry.soup import Soup, plain_soup, unique_names
from ...mesh import FloatArray, Material, Texture, stack_corners
from ..files import InputFiles
from ..images import encode_png, read_texture
from ..limits import require_at_most, unreadable

if TYPE_CHECKING:
    import trimesh

_UNIT = re.compile(rb"<unit\b[^>]*\bmeter\s*=\s*[\"']([^\"']+)[\"']")


class _Resolver:
    """What trimesh asks for referenced files. It swallows exceptions: rejections are kept here."""

    def __init__(self, path: Path, files: InputFiles) -> None:
        self._folder = path.parent
        self._files = files
        self.rejection: InputRejected | None = None
        self.notes: list[str] = []

    def get(self, name: str) -> bytes:
        encoded = partial(self._files.read_reference, name.removeprefix("file:"), self._folder)
        texture = None
        try:
            texture = read_texture(name, encoded, self._files, self.notes)
        except InputRejected as rejection:
            self.rejection = self.rejection or rejection
        if texture is None:
            raise FileNotFoundError(name)
        return texture.data


def read_dae(data: bytes, path: Path, files: InputFiles) -> Soup:
    """Return the triangles of a COLLADA file, scene transforms and instances applied, in metres.

    Raises:
        InputRejected: ``unsupported`` (no pycollada), ``unreadable`` or ``too_large``.
    """
    if find_spec("collada") is None:
        why = "COLLADA needs the package pycollada; install it or convert"
        raise InputRejected("unsupported", f"{path.name}: {why}")
    refuse_doctype(data, path.name)

    import trimesh

    resolver = _Resolver(path, files)
    scene = trimesh.load(io.BytesIO(data), file_type="dae", resolver=resolver, process=False)
    if resolver.rejection is not None:
        raise resolver.rejection
    if isinstance(scene, trimesh.Trimesh):
        scene = trimesh.Scene(scene)
    if not isinstance(scene, trimesh.Scene):
        raise unreadable(path.name, f"holds a {type(scene).__name__}, want meshes")
    unit = _UNIT.search(data)
    soup = _flatten(scene, float(unit.group(1)) if unit else 1.0, path.name, files)
    return replace(soup, notes=tuple(dict.fromkeys(resolver.notes)))


def _flatten(scene: trimesh.Scene, unit: float, name: str, files: InputFiles) -> Soup:
    corners: list[FloatArray] = []
    uvs: list[FloatArray | None] = []
    materials: list[Material] = []
    total = 0
    for node in scene.graph.nodes_geometry:
        matrix, key = scene.graph[node]
        mesh = scene.geometry[key]
        if not hasattr(mesh, "faces"):
            continue
        total += len(mesh.faces)
        require_at_most(name, total, files.limits.max_faces, "faces")
        linear = np.asarray(matrix, dtype=np.float64)
        order = [0, 2, 1] if np.linalg.det(linear[:3, :3]) < 0 else [0, 1, 2]
        points = (np.asarray(mesh.vertices) @ linear[:3, :3].T + linear[:3, 3]) * unit
        faces = np.asarray(mesh.faces, dtype=np.int64)[:, order]
        corners.append(points[faces])
        uv = getattr(mesh.visual, "uv", None)
        fits = uv is not None and len(uv) == len(points)
        uvs.append(np.asarray(uv, dtype=np.float64)[faces][..., :2] if fits else None)
        materials.append(_material(mesh, key))
    if not corners:
        return plain_soup(np.zeros((0, 3, 3)))
    counts = [len(c) for c in corners]
    names = unique_names(m.name for m in materials)
    named = (replace(m, name=n) for n, m in zip(names, materials, strict=True))
    return Soup(
        corners=np.concatenate(corners),
        uv=stack_corners(uvs, counts, 2),
        normals=None,
        face_material=np.repeat(np.arange(len(corners)), counts),
        materials=tuple(named),
    )


def _material(mesh: trimesh.Trimesh, key: str) -> Material:
    source = getattr(mesh.visual, "material", None)
    image = getattr(source, "baseColorTexture", None) or getattr(source, "image", None)
    if image is not None:
        return Material(key, (1.0, 1.0, 1.0, 1.0), Texture(encode_png(image), ".png"))
    color = getattr(source, "main_color", None)
    if color is None or len(color) < 3:
        return Material(key)
    r, g, b = (round(float(c) / 255.0, 6) for c in color[:3])
    return Material(key, (r, g, b, 1.0))
