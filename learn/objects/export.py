"""Objects as files: GLB, OBJ with MTL, sidecar, annotation and URDF. Same object, same bytes.

A file's frame is the rotation and uniform scale from the object frame [m] to its own, shape [4, 4].
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element, SubElement

import numpy as np
import numpy.typing as npt

from asset_factory.factory.articulation import Articulation, Joint, JointKind
from asset_factory.factory.display.gltf import DECIMALS, Y_UP, Buffer, gltf_materials, primitive
from asset_factory.factory.export.text import vector, xml_text
from asset_factory.factory.geometry.posing import posed
from asset_factory.factory.mesh import FloatArray, Mesh

from ..bodies import bodies_of
from ..surfaces.labelled import plain

#: What any furniture's motors stay below, [N m] or [N], and [rad/s] or [m/s]; a URDF wants it.
EFFORT = "100"
VELOCITY = "10"
LICENSE = "Apache-2.0"


def write_sample(
    articulation: Articulation, folder: Path, values: Mapping[str, float] | None = None
) -> None:
    """Write ``object.glb``, ``object.toml``, ``pred.npz``, ``object.urdf``, ``links/<part>.obj``.

    The GLB is the whole object (glTF's y up, metres), its sidecar names ``pred.npz`` as its
    annotation. The URDF says the same in the object frame, with visual meshes only; it has neither
    masses nor collision shapes. Files of these names are replaced.

    Args:
        articulation: any whose parts without faces carry one part each.
        folder: made if need be.
        values: of joints by name [rad] or [m], 0 for the others: the pose that is written.

    Raises:
        KeyError: a value for a joint that is not there.
        ValueError: a value outside its joint's limits.
    """
    shown = posed(articulation, values or {})
    (folder / "links").mkdir(parents=True, exist_ok=True)
    write_glb(shown.mesh, Y_UP, folder / "object.glb")
    write_annotation(shown, Y_UP, folder / "pred.npz")
    sidecar: dict[str, str | float] = {"scale": 1.0, "annotation": "pred.npz", "license": LICENSE}
    write_sidecar(folder / "object.toml", sidecar)
    robot = Element("robot", name="object")
    for index, part in enumerate(shown.parts):
        link = SubElement(robot, "link", name=part.name)
        if len(part.faces):
            file = _write_link(shown, index, folder)
            SubElement(SubElement(SubElement(link, "visual"), "geometry"), "mesh", filename=file)
    for joint in shown.joints:
        robot.append(_joint(shown, joint))
    (folder / "object.urdf").write_text(xml_text(robot), encoding="utf-8", newline="\n")


def _write_link(articulation: Articulation, index: int, folder: Path) -> str:
    shift = np.eye(4)
    shift[:3, 3] = -articulation.link_frame(index)
    file = f"links/{articulation.parts[index].name}.obj"
    write_obj(articulation.part_mesh(index), shift, folder / file)
    return file


def _joint(articulation: Articulation, joint: Joint) -> Element:
    element = Element("joint", name=joint.name, type=str(joint.kind))
    SubElement(element, "parent", link=articulation.parts[joint.parent].name)
    SubElement(element, "child", link=articulation.parts[joint.child].name)
    SubElement(element, "origin", xyz=vector(joint.origin - articulation.link_frame(joint.parent)))
    if joint.movable:
        SubElement(element, "axis", xyz=vector(joint.axis))
        limit = {"effort": EFFORT, "velocity": VELOCITY}
        if joint.kind is not JointKind.CONTINUOUS:
            limit = {"lower": repr(joint.lower), "upper": repr(joint.upper), **limit}
        SubElement(element, "limit", limit)
    return element


def write_glb(mesh: Mesh, frame: FloatArray, path: Path) -> None:
    """Write one node, a primitive per material, images embedded, colours linear."""
    buffer = Buffer()
    placed = mesh.transformed(frame)
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


def write_obj(mesh: Mesh, frame: FloatArray, path: Path) -> None:
    """Write an OBJ and, beside it, an MTL of the same stem; plain colours stand for textures."""
    lines = [f"mtllib {path.stem}.mtl"]
    placed = np.round(mesh.transformed(frame).vertices, DECIMALS) + 0.0
    lines += [f"v {x:.6g} {y:.6g} {z:.6g}" for x, y, z in placed]
    for index, material in enumerate(mesh.materials):
        lines.append(f"usemtl {material.name}")
        lines += [f"f {a} {b} {c}" for a, b, c in mesh.faces[mesh.face_material == index] + 1]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8", newline="\n")
    palette = []
    for material in map(plain, mesh.materials):
        r, g, b, _ = material.color
        palette += [f"newmtl {material.name}", f"Kd {r:g} {g:g} {b:g}", "Ks 0 0 0", "d 1", ""]
    path.with_suffix(".mtl").write_text("\n".join(palette), encoding="utf-8", newline="\n")


def write_sidecar(path: Path, values: dict[str, str | float]) -> None:
    """Write a TOML file of strings and numbers, in the order given."""
    lines = [f"{key} = {json.dumps(value)}" for key, value in values.items()]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8", newline="\n")


def write_annotation(articulation: Articulation, frame: FloatArray, path: Path) -> None:
    """Write ``pred.npz``, in the frame, units and face order of the mesh file beside it.

    A part on a carrier, a part without faces, is one part that turns and slides.

    Fields: ``face_part_ids`` [face_count], ``motion_hierarchy`` [joint_count, 2] (parent, child),
    ``is_part_revolute`` and ``is_part_prismatic`` [part_count], ``revolute_plucker`` [part_count,
    6] (direction l, moment l x p of a point p on the axis), ``prismatic_axis`` [part_count, 3], and
    the two ranges [part_count, 2] relative to the pose of the file [rad, file units].

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
    turn = frame[:3, :3]
    scale = float(np.cbrt(np.linalg.det(turn)))
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
        limits = np.array([joint.lower, joint.upper])
        direction = turn @ joint.axis / scale
        kind = "prismatic" if joint.kind is JointKind.PRISMATIC else "revolute"
        if kind == "prismatic":
            limits = limits * scale
            arrays["prismatic_axis"][child] = np.round(direction, 9) + 0.0
        else:
            moment = np.cross(direction, turn @ joint.origin + frame[:3, 3])
            arrays["revolute_plucker"][child] = np.round([*direction, *moment], 9) + 0.0
        arrays[f"is_part_{kind}"][child] = True
        arrays[f"{kind}_range"][child] = np.round(limits, 9)
    np.savez(path, allow_pickle=False, **arrays)
