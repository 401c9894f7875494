"""URDF as written, with every mesh that it names: http://wiki.ros.org/urdf/XML."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ..description import (
    DescribedShape,
    Description,
    DescriptionError,
    FloatArray,
    IntArray,
    Link,
    LinkInertia,
    Mimic,
)
from ..geometry.kinematics import MOVING_KINDS
from ..geometry.placing import placed
from .document import find_file, parse_document
from .meshes import read_mesh
from .primitives import box, capsule, cylinder, ellipsoid
from .references import SRDF, refuse_outside_mesh, refuse_outside_urdf
from .urdf_elements import STRICT, TENSOR, number, read_mimic

#: Of all shapes of one file together.
MAX_TRIANGLES = 20_000_000
#: Makers of shapes by their name, from sizes as a URDF states them [m].
PRIMITIVES: dict[str, Callable[..., tuple[FloatArray, IntArray]]] = {
    "box": lambda *edges: box(np.array(edges)),
    "cylinder": cylinder,
    "capsule": capsule,
    "sphere": lambda radius: ellipsoid(np.full(3, radius)),
}


@dataclass
class _Shapes:
    """The meshes read so far, and how many triangles all shapes have together."""

    folder: Path
    meshes: dict[Path, tuple[FloatArray, IntArray]] = field(default_factory=dict)
    triangles: int = 0

    def mesh(self, path: Path) -> tuple[FloatArray, IntArray]:
        if path not in self.meshes:
            refuse_outside_mesh(path, self.folder)
            self.meshes[path] = read_mesh(path)
        return self.meshes[path]

    def count(self, triangles: int, where: str) -> None:
        self.triangles += triangles
        if self.triangles > MAX_TRIANGLES:
            brings = f"{where}: brings the shapes to {self.triangles} triangles"
            raise DescriptionError("too_large", f"{brings}, at most {MAX_TRIANGLES} are read")


def read_urdf(path: Path, robot: ET.Element) -> Description:
    """Read a URDF, given with its root element, and every mesh it names.

    Raises:
        DescriptionError: with a stable code, whatever is wrong with the file.
    """
    refuse_outside_urdf(path, robot)
    shapes = _Shapes(path.parent.resolve())
    links = tuple(_link(element, shapes) for element in robot.findall("link"))
    joints = tuple(STRICT.joint(element) for element in robot.findall("joint"))
    if not links:
        raise DescriptionError("no_links", f"{path.name}: <robot> holds no <link>")
    names = {link.name for link in links}
    exempt = frozenset(pair for pair in exempt_pairs(path) if pair <= names)
    return Description(path, "urdf", links, joints, exempt)


def exempt_pairs(urdf: Path) -> frozenset[frozenset[str]]:
    """Return the pairs of names that the SRDF beside a URDF, called like it, disables.

    They may pass through each other. The format: http://wiki.ros.org/srdf.

    Raises:
        DescriptionError: it is no XML.
    """
    path = urdf.with_suffix(SRDF)
    if not path.is_file():
        return frozenset()
    items = parse_document(path).iter("disable_collisions")
    pairs = (frozenset((item.get("link1", ""), item.get("link2", ""))) for item in items)
    return frozenset(pair for pair in pairs if len(pair) == 2 and "" not in pair)


def read_mimics(path: Path) -> dict[str, Mimic | None]:
    """Return what a URDF has each joint follow that moves; no mesh is read.

    Raises:
        DescriptionError: for a follower that names no joint, or no number.
    """
    joints = parse_document(path).findall("joint")
    moving = ((STRICT.name(item), item) for item in joints if item.get("type") in MOVING_KINDS)
    return {name: read_mimic(item.find("mimic"), f"joint {name!r}") for name, item in moving}


def _link(element: ET.Element, shapes: _Shapes) -> Link:
    name = STRICT.name(element)
    collisions = tuple(_shape(item, name, shapes) for item in element.findall("collision"))
    visuals = tuple(_shape(item, name, shapes) for item in element.findall("visual"))
    inertial = element.find("inertial")
    return Link(name, None if inertial is None else _inertia(inertial, name), collisions, visuals)


def _inertia(element: ET.Element, link: str) -> LinkInertia | None:
    mass = element.find("mass")
    tensor = element.find("inertia")
    if mass is None or tensor is None:
        return None
    where = f"<inertial> of link {link!r}"
    xx, xy, xz, yy, yz, zz = (number(tensor, key, where, 0.0) for key in TENSOR)
    pose = STRICT.origin(element, where)
    matrix = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    turned = pose[:3, :3] @ matrix @ pose[:3, :3].T
    return LinkInertia(number(mass, "value", where, 0.0), pose[:3, 3], turned)


def _shape(element: ET.Element, link: str, shapes: _Shapes) -> DescribedShape:
    where = f"<{element.tag}> of link {link!r}"
    geometry = STRICT.geometry(element, where)
    if geometry is None:
        raise DescriptionError("missing_geometry", f"{where} holds no geometry")
    file: str | None = None
    name = geometry.kind
    if geometry.kind == "mesh":
        path = find_file(geometry.file, shapes.folder)
        vertices, faces = shapes.mesh(path)
        vertices = vertices * geometry.scale
        file = path.relative_to(shapes.folder).as_posix()
        name = path.name
    else:
        vertices, faces = PRIMITIVES[geometry.kind](*geometry.size)
    shapes.count(len(faces), where)
    vertices = placed(vertices, STRICT.origin(element, where))
    return DescribedShape(element.get("name") or name, geometry.kind, vertices, faces, file)
