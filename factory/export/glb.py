"""Asset -> GLB: the visual meshes in a chain of links, with animations that open its joints.

Link nodes have the frames of the URDF, below one node that turns z up into glTF's y up; ``extras``
say what glTF has no word for. The first animation opens everything, then comes one for each joint.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from ..articulation import Joint
from ..display.gltf import Y_UP, Attribute, Buffer, gltf_materials, primitive
from ..mesh import FloatArray
from ..runtime.numbers import magnitude
from .links import Layout, LinkLayout
from .meshes import filled_normals

#: From closed to open, a rest there, and back [s].
OPENING_S = 1.5
RESTING_S = 0.5
#: Between two keys a joint turns by no more [rad]: engines interpolate rotations along a chord.
KEY_STEP = np.pi / 8.0


def write_glb_asset(layout: Layout, file: Path) -> None:
    """Write the whole asset as one GLB; textures of the bundle are embedded."""
    buffer = Buffer()
    pieces = [piece for link in layout.links for piece in link.visuals]
    number = {piece.name: index for index, piece in enumerate(pieces)}
    links = [_link(link, buffer, number) for link in layout.links]
    # The first node turns the asset upright; those of the links come after it, in order.
    upright = [round(each, 9) + 0.0 for each in Rotation.from_matrix(Y_UP[:3, :3]).as_quat()]
    nodes: list[dict[str, Any]] = [
        {"name": layout.asset.name, "rotation": upright, "children": [1]}
    ]
    meshes: list[dict[str, Any]] = []
    for joint in layout.asset.articulation.joints:
        links[joint.parent].setdefault("children", []).append(joint.child + 1)
    for node in links:
        primitives = node.pop("primitives")
        if primitives:
            node["mesh"] = len(meshes)
            meshes.append({"primitives": primitives})
        nodes.append(node)
    files = (None if piece.texture is None else file.parent / piece.texture for piece in pieces)
    images = tuple(each if each is None else each.read_bytes() for each in files)
    document = {
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": nodes,
        "meshes": meshes,
        **gltf_materials(buffer, tuple(piece.material for piece in pieces), images),
    }
    animations = _animations(layout, buffer)
    if animations:
        document["animations"] = animations
    file.write_bytes(buffer.glb({key: value for key, value in document.items() if value}))


def _link(link: LinkLayout, buffer: Buffer, number: dict[str, int]) -> dict[str, Any]:
    primitives = []
    for piece in link.visuals:
        mesh = replace(piece.mesh, vertices=piece.mesh.vertices - link.origin)
        faces = np.arange(len(mesh.faces))
        made = primitive(buffer, mesh, faces, filled_normals(mesh))
        primitives.append({**made, "material": number[piece.name]})
    extras: dict[str, Any] = {"mass_kg": magnitude(link.inertial.mass)}
    joint = link.joint
    if joint is not None:
        extras["joint"] = {
            "name": joint.name,
            "type": str(joint.kind),
            "axis": joint.axis.tolist(),
            "lower": joint.lower,
            "upper": joint.upper,
            "unit": joint.unit,
        }
    return {
        "name": link.name,
        "translation": link.offset.tolist(),
        "extras": extras,
        "primitives": primitives,
    }


def _animations(layout: Layout, buffer: Buffer) -> list[dict[str, Any]]:
    moved = ((link.joint, link.offset) for link in layout.links if link.joint is not None)
    motions = [(joint, *_keys(joint, offset, buffer)) for joint, offset in moved if joint.movable]
    groups = [("open everything", motions)] if len(motions) > 1 else []
    groups += [(f"open {motion[0].name}", [motion]) for motion in motions]
    return [
        {
            "name": name,
            "samplers": [{"input": times, "output": values} for _, times, values in chosen],
            "channels": [
                {
                    "sampler": index,
                    "target": {
                        "node": joint.child + 1,
                        "path": "rotation" if joint.turns else "translation",
                    },
                }
                for index, (joint, _, _) in enumerate(chosen)
            ],
        }
        for name, chosen in groups
    ]


def _keys(joint: Joint, offset: FloatArray, buffer: Buffer) -> tuple[int, int]:
    """Add a joint's way to its upper limit and back; return accessors of times and of poses."""
    steps = int(np.ceil((joint.upper - joint.lower) / KEY_STEP)) if joint.turns else 1
    share = np.linspace(0.0, 1.0, max(steps, 1) + 1)
    times = np.concatenate([share * OPENING_S, OPENING_S + RESTING_S + share * OPENING_S])
    values = joint.lower + np.concatenate([share, share[::-1]]) * (joint.upper - joint.lower)
    rows: Attribute
    if joint.turns:
        half = values[:, None] / 2.0
        rows = np.hstack([np.sin(half) * joint.axis, np.cos(half)]).astype(np.float32)
    else:
        rows = (offset + values[:, None] * joint.axis).astype(np.float32)
    return buffer.keys(times.astype(np.float32)), buffer.keys(rows)
