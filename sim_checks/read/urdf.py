"""URDF as written: http://wiki.ros.org/urdf/XML."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ..description import (
    ABSURD,
    DescribedShape,
    Description,
    DescriptionError,
    FloatArray,
    IntArray,
    JointLine,
    Link,
    LinkInertia,
    Mimic,
    sensible,
)
from ..geometry.kinematics import MOVING_KINDS
from .document import find_file, parse_document
from .meshes import read_mesh
from .primitives import box, capsule, cylinder, ellipsoid
from .references import refuse_outside_mesh, refuse_outside_urdf

#: Of all shapes of one file together.
MAX_TRIANGLES = 20_000_000


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
            message = (
                f"{where}: brings the shapes to {self.triangles} triangles, "
                f"at most {MAX_TRIANGLES} are read"
            )
            raise DescriptionError("too_large", message)


def read_urdf(path: Path) -> Description:
    """Read a URDF and every mesh it names.

    Raises:
        DescriptionError: with a stable code, whatever is wrong with the file.
    """
    robot = parse_document(path)
    refuse_outside_urdf(path, robot)
    shapes = _Shapes(path.parent.resolve())
    links = tuple(_link(element, shapes) for element in robot.findall("link"))
    joints = tuple(_joint(element) for element in robot.findall("joint"))
    if not links:
        raise DescriptionError("no_links", f"{path.name}: <robot> holds no <link>")
    return Description(path, "urdf", links, joints)


def read_mimics(path: Path) -> dict[str, Mimic | None]:
    """Of every joint that moves, what a URDF has it follow; no mesh is read.

    Raises:
        DescriptionError: for a follower that names no joint, or no number.
    """
    moving = [
        item for item in parse_document(path).findall("joint") if item.get("type") in MOVING_KINDS
    ]
    return {
        _name(item): _mimic(item.find("mimic"), f"joint {item.get('name')!r}") for item in moving
    }


def _link(element: ET.Element, shapes: _Shapes) -> Link:
    name = _name(element)
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
    xx, xy, xz, yy, yz, zz = (
        _number(tensor, key, where, 0.0) for key in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    )
    pose = _origin(element, where)
    matrix = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    rotation = pose[:3, :3]
    return LinkInertia(
        _number(mass, "value", where, 0.0), pose[:3, 3], rotation @ matrix @ rotation.T
    )


def _shape(element: ET.Element, link: str, shapes: _Shapes) -> DescribedShape:
    where = f"<{element.tag}> of link {link!r}"
    geometry = element.find("geometry")
    item = None if geometry is None else next(iter(geometry), None)
    if item is None:
        raise DescriptionError("missing_geometry", f"{where} holds no geometry")
    file: str | None = None
    name = item.tag
    if item.tag == "mesh":
        path = find_file(item.get("filename", ""), shapes.folder)
        vertices, faces = shapes.mesh(path)
        vertices = vertices * _vector(item, "scale", where, "1 1 1")
        file = path.relative_to(shapes.folder).as_posix()
        name = path.name
    elif item.tag in _PRIMITIVES:
        vertices, faces = _PRIMITIVES[item.tag](item, where)
    else:
        raise DescriptionError(
            "unknown_geometry", f"{where}: <{item.tag}>, want mesh or one of {sorted(_PRIMITIVES)}"
        )
    shapes.count(len(faces), where)
    pose = _origin(element, where)
    placed = vertices @ pose[:3, :3].T + pose[:3, 3]
    return DescribedShape(element.get("name") or name, item.tag, placed, faces, file)


def _box(item: ET.Element, where: str) -> tuple[FloatArray, IntArray]:
    size = _vector(item, "size", where)
    if size.min() <= 0.0:
        raise DescriptionError(
            "invalid_size", f"{where}: size={item.get('size')!r}, want three numbers above 0"
        )
    return box(size)


def _cylinder(item: ET.Element, where: str) -> tuple[FloatArray, IntArray]:
    return cylinder(_length(item, "radius", where), _length(item, "length", where))


def _capsule(item: ET.Element, where: str) -> tuple[FloatArray, IntArray]:
    return capsule(_length(item, "radius", where), _length(item, "length", where))


def _sphere(item: ET.Element, where: str) -> tuple[FloatArray, IntArray]:
    return ellipsoid(np.full(3, _length(item, "radius", where)))


_PRIMITIVES: dict[str, Callable[[ET.Element, str], tuple[FloatArray, IntArray]]] = {
    "box": _box,
    "cylinder": _cylinder,
    "capsule": _capsule,
    "sphere": _sphere,
}


def _joint(element: ET.Element) -> JointLine:
    name = _name(element)
    where = f"joint {name!r}"
    limit = element.find("limit")
    dynamics = element.find("dynamics")
    axis = element.find("axis")
    kind = element.get("type", "")
    bounded = limit is not None and kind not in ("continuous", "fixed", "floating")
    return JointLine(
        name=name,
        kind=kind,
        parent=_child_link(element, "parent", where),
        child=_child_link(element, "child", where),
        origin=_origin(element, where),
        axis=np.array([1.0, 0.0, 0.0]) if axis is None else _vector(axis, "xyz", where),
        lower=_number(limit, "lower", where, 0.0) if bounded and limit is not None else None,
        upper=_number(limit, "upper", where, 0.0) if bounded and limit is not None else None,
        damping=0.0 if dynamics is None else _number(dynamics, "damping", where, 0.0),
        friction=0.0 if dynamics is None else _number(dynamics, "friction", where, 0.0),
        mimic=_mimic(element.find("mimic"), where),
        effort=_optional(limit, "effort", where),
        velocity=_optional(limit, "velocity", where),
    )


def _optional(element: ET.Element | None, key: str, where: str) -> float | None:
    return None if element is None or element.get(key) is None else _number(element, key, where)


def _mimic(element: ET.Element | None, where: str) -> Mimic | None:
    if element is None:
        return None
    leader = element.get("joint")
    if not leader:
        raise DescriptionError("missing_element", f"{where}: its <mimic> names no joint")
    return Mimic(
        leader, _number(element, "multiplier", where, 1.0), _number(element, "offset", where, 0.0)
    )


def _child_link(element: ET.Element, tag: str, where: str) -> str:
    item = element.find(tag)
    link = None if item is None else item.get("link")
    if not link:
        raise DescriptionError("missing_element", f"{where}: no <{tag} link=...>")
    return link


def _name(element: ET.Element) -> str:
    name = element.get("name")
    if not name:
        raise DescriptionError("missing_name", f"a <{element.tag}> has no name")
    return name


def _origin(element: ET.Element, where: str) -> FloatArray:
    item = element.find("origin")
    pose = np.eye(4)
    if item is not None:
        pose[:3, :3] = rotation_from_rpy(_vector(item, "rpy", where, "0 0 0"))
        pose[:3, 3] = _vector(item, "xyz", where, "0 0 0")
    return pose


def rotation_from_rpy(rpy: FloatArray) -> FloatArray:
    """Rotation by roll, pitch and yaw about the fixed axes x, y and z [rad]; shape [3, 3]."""
    from scipy.spatial.transform import Rotation

    return Rotation.from_euler("xyz", rpy).as_matrix()


def _length(element: ET.Element, key: str, where: str) -> float:
    value = _number(element, key, where)
    if not sensible(value):
        message = f"{where}: {key}={element.get(key)!r}, want a number up to {ABSURD:g}"
        raise DescriptionError("not_finite", message)
    if value <= 0.0:
        raise DescriptionError(
            "invalid_size", f"{where}: {key}={element.get(key)!r}, want more than 0"
        )
    return value


def _number(element: ET.Element, key: str, where: str, default: float | None = None) -> float:
    text = element.get(key)
    if text is None:
        if default is None:
            raise DescriptionError("missing_number", f"{where}: <{element.tag}> has no {key}")
        return default
    try:
        return float(text)
    except ValueError as error:
        raise DescriptionError("invalid_number", f"{where}: {key}={text!r} is no number") from error


def _vector(element: ET.Element, key: str, where: str, default: str | None = None) -> FloatArray:
    text = element.get(key, default)
    if text is None:
        raise DescriptionError("missing_number", f"{where}: <{element.tag}> has no {key}")
    try:
        values = [float(word) for word in text.split()]
    except ValueError as error:
        raise DescriptionError(
            "invalid_number", f"{where}: {key}={text!r}, want numbers"
        ) from error
    if len(values) != 3:
        raise DescriptionError("invalid_number", f"{where}: {key}={text!r}, want three numbers")
    if not sensible(values):
        raise DescriptionError(
            "not_finite",
            f"{where}: {key}={text!r}, want numbers between -{ABSURD:g} and {ABSURD:g}",
        )
    return np.array(values)
