"""Objects as files: GLB, sidecar and annotation. Same object, same bytes."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from asset_factory.factory.articulation import Articulation
from asset_factory.factory.display.gltf import Y_UP, Buffer, gltf_materials, primitive
from asset_factory.factory.geometry.posing import posed, rotated
from asset_factory.factory.mesh import Mesh

from ..bodies import bodies_of

LICENSE = "Apache-2.0"


def write_sample(
    articulation: Articulation, folder: Path, values: Mapping[str, float] | None = None
) -> None:
    """Write ``object.glb``, its sidecar ``object.toml`` and its annotation ``pred.npz``.

    The GLB is the whole object (glTF's y up, metres). Files of these names are replaced.

    Args:
        articulation: any whose parts without faces carry one part each.
        folder: made if need be.
        values: of joints by name [rad] or [m], 0 for the others: the pose that is written.

    Raises:
        KeyError: a value for a joint that is not there.
        ValueError: a value outside its joint's limits.
    """
    shown = posed(articulation, values or {})
    folder.mkdir(parents=True, exist_ok=True)
    write_glb(shown.mesh, folder / "object.glb")
    write_annotation(rotated(shown, Y_UP[:3, :3]), folder / "pred.npz")
    sidecar: dict[str, str | float] = {"scale": 1.0, "annotation": "pred.npz", "license": LICENSE}
    write_sidecar(folder / "object.toml", sidecar)


def write_glb(mesh: Mesh, path: Path) -> None:
    """Write one node, y up, a primitive per material, images embedded, colours linear."""
    buffer = Buffer()
    placed = mesh.transformed(Y_UP)
    owned = [np.flatnonzero(mesh.face_material == index) for index in range(len(mesh.materials))]
    meshes = [{**primitive(buffer, placed, own), "material": i} for i, own in enumerate(owned)]
    images = tuple(None if m.texture is None else m.texture.data for m in mesh.materials)
    document: dict[str, Any] = {"scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}]}
    document |= {"meshes": [{"primitives": meshes}]}
    document |= gltf_materials(buffer, mesh.materials, images)
    if "textures" in document:
        # Pixels stay pixels, and repeat.
        document["samplers"] = [{"magFilter": 9728, "wrapS": 10497, "wrapT": 10497}]
    path.write_bytes(buffer.glb(document))


def write_sidecar(path: Path, values: dict[str, str | float]) -> None:
    """Write a TOML file of strings and numbers, in the order given."""
    lines = [f"{key} = {json.dumps(value)}" for key, value in values.items()]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8", newline="\n")


def write_annotation(articulation: Articulation, path: Path) -> None:
    """Write ``pred.npz`` for the file of a mesh in this frame, in the order of that file's faces.

    A part on a carrier, a part without faces, is one part that turns and slides.

    Fields: ``face_part_ids`` [face_count], ``motion_hierarchy`` [joint_count, 2] (parent, child),
    ``is_part_revolute`` and ``is_part_prismatic`` [part_count], ``revolute_plucker`` [part_count,
    6] (direction l, moment l x p of a point p on the axis), ``prismatic_axis`` [part_count, 3], and
    the two ranges [part_count, 2] relative to this pose [rad, m].

    Raises:
        ValueError: a carrier does not carry exactly one part, or not by the other kind of joint;
            or the root has no faces.
    """
    bodies = bodies_of(articulation)
    moves = [(child, joint) for child, own in enumerate(bodies.joints) for joint in own]
    kinds = {(child, joint.turns) for child, joint in moves}
    once = len(kinds) == len({joint.name for _, joint in moves}) == len(moves)
    if bodies.parts[0] != 0 or not once:
        wanted = "want one to carry one part that turns and slides by it, and faces on the root"
        raise ValueError(f"a part without faces: {wanted}")
    count = len(bodies)
    order = np.argsort(articulation.mesh.face_material, kind="stable")
    edges = [(parent, child) for child, parent in enumerate(bodies.parents) if child]
    arrays: dict[str, npt.NDArray[Any]] = {
        # Files hold the faces material by material.
        "face_part_ids": bodies.labels.astype(np.int32)[order],
        "motion_hierarchy": np.array(edges, dtype=np.int64).reshape(-1, 2),
        "is_part_revolute": np.zeros(count, dtype=bool),
        "is_part_prismatic": np.zeros(count, dtype=bool),
        "revolute_plucker": np.zeros((count, 6)),
        "revolute_range": np.zeros((count, 2), dtype=np.float32),
        "prismatic_axis": np.zeros((count, 3), dtype=np.float32),
        "prismatic_range": np.zeros((count, 2), dtype=np.float32),
    }
    for child, joint in moves:
        kind = "revolute" if joint.turns else "prismatic"
        if joint.turns:
            line = [*joint.axis, *np.cross(joint.axis, joint.origin)]
            arrays["revolute_plucker"][child] = np.round(line, 9) + 0.0
        else:
            arrays["prismatic_axis"][child] = np.round(joint.axis, 9) + 0.0
        arrays[f"is_part_{kind}"][child] = True
        arrays[f"{kind}_range"][child] = np.round([joint.lower, joint.upper], 9)
    np.savez(path, allow_pickle=False, **arrays)
