"""The scene of an asset that was just made: nothing is read from files."""

from __future__ import annotations

import io
from dataclasses import replace

import numpy as np
from PIL import Image

from ..articulation import Articulation, JointKind
from ..asset import Asset
from ..geometry.rows import distinct_rows
from ..mesh import FloatArray, IntArray, Mesh, Texture
from .scene import UNLIMITED, Color, SceneGraph, SceneJoint, SceneSurface

#: Longest side of a picture on a surface [pixels]: enough for a page, a fraction of the bytes.
MAX_TEXTURE = 1024


def scene_of(asset: Asset, before: Asset | None = None) -> SceneGraph:
    """Return an asset's scene: links in the order of parts, frames as in its URDF.

    ``before`` is what it was before repairs, whose other hulls are shown too.
    """
    articulation = asset.articulation
    hulls = [
        plain_surface(index, hull.vertices - articulation.link_frame(index), hull.faces)
        for index, body in enumerate(asset.bodies)
        for hull in body.hulls
    ]
    replaced = _replaced(asset, before) if before else []
    bare = scene_of_articulation(asset.name, articulation)
    return replace(bare, hulls=tuple(hulls), replaced=tuple(replaced))


def scene_of_articulation(name: str, articulation: Articulation) -> SceneGraph:
    """Return the scene of parts and joints, before anything is made of them."""
    visuals: list[SceneSurface] = []
    images: dict[Texture, bytes | None] = {}
    for index, part in enumerate(articulation.parts):
        frame = articulation.link_frame(index)
        if len(part.faces):
            visuals += surfaces_of(articulation.mesh.submesh(part.faces), index, frame, images)
    joints = []
    for joint in articulation.joints:
        origin = np.eye(4)
        origin[:3, 3] = joint.origin - articulation.link_frame(joint.parent)
        endless = joint.kind is JointKind.CONTINUOUS
        lower = 0.0 if endless else joint.lower
        upper = UNLIMITED["continuous"] if endless else joint.upper
        ends = (joint.parent, joint.child)
        kind = str(joint.kind)
        joints.append(SceneJoint(joint.name, kind, *ends, origin, joint.axis, lower, upper))
    names = tuple(part.name for part in articulation.parts)
    return SceneGraph(name, names, tuple(joints), tuple(visuals))


def _replaced(asset: Asset, before: Asset) -> list[SceneSurface]:
    """Return the hulls that are no more, on the links of their parts, else on the root."""
    kept = {hull.vertices.tobytes() for body in asset.bodies for hull in body.hulls}
    links = {part.name: number for number, part in enumerate(asset.articulation.parts)}
    found = []
    for part, body in zip(before.articulation.parts, before.bodies, strict=True):
        link = links.get(part.name, 0)
        frame = asset.articulation.link_frame(link)
        found += [
            plain_surface(link, hull.vertices - frame, hull.faces)
            for hull in body.hulls
            if hull.vertices.tobytes() not in kept
        ]
    return found


def scene_of_mesh(name: str, mesh: Mesh) -> SceneGraph:
    """Return a mesh as an object of one link, nothing of which moves."""
    return SceneGraph(name, ("object",), (), tuple(surfaces_of(mesh, 0, np.zeros(3), {})))


def surfaces_of(
    mesh: Mesh, link: int, frame: FloatArray, images: dict[Texture, bytes | None]
) -> list[SceneSurface]:
    """Return one surface per material of a mesh [m].

    Args:
        mesh: any.
        link: that it is on.
        frame: origin of the link's frame, the axes being the mesh's, shape [3].
        images: those made so far; more are added.
    """
    found = []
    for index in range(len(mesh.materials)):
        own = mesh.submesh(np.flatnonzero(mesh.face_material == index))
        if len(own.faces):
            found.append(_surface(own, link, frame, images))
    return found


def _surface(
    mesh: Mesh, link: int, frame: FloatArray, images: dict[Texture, bytes | None]
) -> SceneSurface:
    """Return a mesh of one material, its corners split only where normals or coordinates differ."""
    material = mesh.materials[0]
    image = None
    if material.texture is not None and mesh.corner_uv is not None:
        if material.texture not in images:
            images[material.texture] = small_image(material.texture.data)
        image = images[material.texture]
    normals = mesh.corner_normals
    if normals is not None and not np.isfinite(normals).all():
        normals = None
    uv = None if image is None else mesh.corner_uv
    if uv is not None:
        uv = np.nan_to_num(np.clip(uv, -1e4, 1e4))
    columns = [mesh.vertices[mesh.faces].reshape(-1, 3) - frame]
    columns += [] if normals is None else [normals.reshape(-1, 3)]
    columns += [] if uv is None else [uv.reshape(-1, 2)]
    if len(columns) == 1:
        return plain_surface(link, mesh.vertices - frame, mesh.faces, material.color)
    rows = np.hstack(columns).astype(np.float32)
    first, faces = distinct_rows(rows)
    rows = rows[first]
    return SceneSurface(
        link,
        rows[:, :3],
        faces.reshape(-1, 3).astype(np.int32),
        None if normals is None else rows[:, 3:6],
        None if uv is None else rows[:, -2:],
        material.color,
        image,
    )


def plain_surface(
    link: int, vertices: FloatArray, faces: IntArray, color: Color = SceneSurface.color
) -> SceneSurface:
    """Return the triangles of one colour, every one flat; arguments: :class:`SceneSurface`."""
    return SceneSurface(link, vertices.astype(np.float32), faces.astype(np.int32), color=color)


def small_image(data: bytes) -> bytes | None:
    """Return the picture as JPEG, PNG if transparent; ``None`` if it cannot be decoded."""
    try:
        with Image.open(io.BytesIO(data), formats=("PNG", "JPEG")) as image:
            image.draft("RGB", (MAX_TEXTURE, MAX_TEXTURE))
            transparent = image.mode in ("RGBA", "LA", "PA") or "transparency" in image.info
            plain = image.convert("RGBA" if transparent else "RGB")
            if transparent and plain.getchannel("A").getextrema() == (255, 255):
                plain = plain.convert("RGB")
            plain.thumbnail((MAX_TEXTURE, MAX_TEXTURE), Image.Resampling.BILINEAR)
            buffer = io.BytesIO()
            if plain.mode == "RGBA":
                plain.save(buffer, format="PNG", compress_level=6)
            else:
                plain.save(buffer, format="JPEG", quality=82)
            return buffer.getvalue()
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError):
        return None
