"""One labelled object as files: GLB, URDF with a mesh a link, and ``pred.npz``."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from xml.etree.ElementTree import Element, SubElement

import numpy as np

from asset_factory.factory.articulation import Articulation, Joint, JointKind
from asset_factory.factory.display.gltf import Y_UP
from asset_factory.factory.export.text import vector, xml_text
from asset_factory.factory.geometry.posing import posed

from ..surfaces.labelled import plain
from .export import write_annotation, write_glb, write_obj, write_sidecar

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
    mesh = articulation.part_mesh(index)
    looks = tuple(plain(material) for material in mesh.materials)
    mesh = replace(mesh, materials=looks, corner_uv=None)
    shift = np.eye(4)
    shift[:3, 3] = -articulation.link_frame(index)
    file = f"links/{articulation.parts[index].name}.obj"
    write_obj(mesh, shift, folder / file)
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
