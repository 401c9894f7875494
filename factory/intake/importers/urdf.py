"""URDF: links, joints and visuals, posed with every joint at zero.

The format: http://wiki.ros.org/urdf/XML. Allowed here and not there: several ``<visual>``
of one name, several ``<inertial>`` (neither matters to an import), and ``<capsule>``.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from contextlib import suppress
from pathlib import Path

import numpy as np

from asset_factory.sim_checks.description import (
    Description,
    DescriptionError,
    FloatArray,
    JointLine,
    Link,
    Mimic,
)
from asset_factory.sim_checks.geometry.kinematics import MOVING_KINDS, NotATree, build_tree
from asset_factory.sim_checks.read.urdf_elements import LENIENT, read_mimic

from ...config import IntakeConfig
from ...errors import InputRejected
from ...mesh import Mesh
from ...runtime.store import digest_file
from ..annotation import AnnotatedJoint
from ..limits import require_at_most
from ..reads import ReadLog
from .imported import Imported, rigid_groups
from .urdf_geometry import ShapeReader

MAX_LINKS = 4096
MAX_SHAPES = 10_000


def import_urdf(robot: ET.Element, path: Path, config: IntakeConfig, log: ReadLog) -> Imported:
    """Return every link's visuals and every joint of a URDF, in the root link's frame.

    What ``path`` refers to lies in or below its folder.

    Raises:
        InputRejected: ``not_a_tree``, ``unsupported_joint``, ``missing_file``,
            ``external_reference``, ``unreadable``, ``too_large``.
    """
    links = robot.findall("link")
    for what, elements in (("links", links), ("joints", robot.findall("joint"))):
        require_at_most(path.name, len(elements), MAX_LINKS, what)
    names = tuple(LENIENT.name(link) for link in links)
    joints = [_joint(element, path.name) for element in robot.findall("joint")]
    poses = _poses(names, joints, path)
    notes = _notes(robot, joints)
    reader = ShapeReader(robot, path.parent, config, log)
    part_of = {name: part for part, name in enumerate(names)}
    welds = [(part_of[j.parent], part_of[j.child]) for j in joints if j.kind == "fixed"]
    shapes = _choose_shapes(links, rigid_groups(len(names), welds), notes)
    require_at_most(path.name, len(shapes), MAX_SHAPES, "shapes")
    pieces: list[tuple[int, Mesh]] = []
    faces = 0
    for part, element in shapes:
        where = f"{path.name}: link {names[part]!r}"
        mesh = reader.read(element, where)
        if mesh is not None:
            faces += len(mesh.faces)
            require_at_most(path.name, faces, config.max_faces, "faces")
            pose = poses[names[part]] @ LENIENT.origin(element, where)
            pieces.append((part, reader.painted(mesh, element, where).transformed(pose)))
    return Imported(
        pieces=tuple(pieces),
        part_names=names,
        joints=tuple(
            _annotated(joint, part_of, poses[joint.child], element)
            for joint, element in zip(joints, robot.findall("joint"), strict=True)
        ),
        digests=(digest_file(path), *reader.digests),
        notes=(*notes, *reader.notes),
        source="urdf",
        licenses=tuple(dict.fromkeys(v.license for v in reader.visuals if v.license)),
        dropped_degenerate=sum(v.dropped_degenerate for v in reader.visuals),
        dropped_non_finite=sum(v.dropped_non_finite for v in reader.visuals),
    )


def _joint(element: ET.Element, file: str) -> JointLine:
    joint = LENIENT.joint(element)
    if joint.kind not in (*MOVING_KINDS, "fixed", "floating"):
        want = "want fixed, revolute, continuous or prismatic"
        why = f"{file}: joint {joint.name!r}: is of type {joint.kind!r}; {want}"
        raise InputRejected("unsupported_joint", why)
    return joint


def _poses(names: tuple[str, ...], joints: list[JointLine], path: Path) -> dict[str, FloatArray]:
    """Return every link's pose in the root's frame, shape [4, 4] each."""
    if not names:
        raise InputRejected("not_a_tree", f"{path.name}: has no <link>, want at least one")
    links = tuple(Link(name, None, (), ()) for name in names)
    try:
        tree = build_tree(Description(path, "urdf", links, tuple(joints)))
    except NotATree as error:
        raise InputRejected("not_a_tree", f"{path.name}: {error}") from error
    poses = {tree.root: np.eye(4)}
    for joint in tree.order:
        poses[joint.child] = poses[joint.parent] @ joint.origin
    return poses


def _choose_shapes(
    links: list[ET.Element], groups: list[int], notes: list[str]
) -> list[tuple[int, ET.Element]]:
    """Return visuals; for links welded together that have none, their collision shapes."""
    seen = {groups[part] for part, link in enumerate(links) if link.find("visual") is not None}
    chosen: list[tuple[int, ET.Element]] = []
    for part, link in enumerate(links):
        visuals = link.findall("visual")
        collisions = link.findall("collision")
        if groups[part] not in seen and collisions:
            bare = f"link {link.get('name')!r} has no visual geometry"
            notes.append(f"{bare}; its collision geometry is used")
            visuals = collisions
        chosen += [(part, shape) for shape in visuals]
    return chosen


def _notes(robot: ET.Element, joints: list[JointLine]) -> list[str]:
    notes = []
    for element in robot.findall("joint"):
        if element.find("mimic") is not None and _mimic(element) is None:
            name = element.get("name")
            notes.append(f"joint {name!r}: its mimic cannot be read; it moves freely")
    floating = (joint.name for joint in joints if joint.kind == "floating")
    notes += [f"joint {n!r} is floating in the file; its link is held fixed" for n in floating]
    rows = ("scale", "size", "xyz", "rpy")
    commas = {e.tag for e in robot.iter() if any("," in e.get(name, "") for name in rows)}
    if commas:
        notes.append(f"commas between numbers are read as spaces: {', '.join(sorted(commas))}")
    return notes


def _annotated(
    joint: JointLine, part_of: dict[str, int], frame: FloatArray, element: ET.Element
) -> AnnotatedJoint:
    dynamics = element.find("dynamics")
    return AnnotatedJoint(
        name=joint.name,
        kind=joint.kind if joint.kind in MOVING_KINDS else "fixed",
        parent=part_of[joint.parent],
        child=part_of[joint.child],
        axis=frame[:3, :3] @ joint.axis,
        origin=frame[:3, 3].copy(),
        lower=joint.lower,
        upper=joint.upper,
        damping=_number(dynamics, "damping"),
        friction=_number(dynamics, "friction"),
        mimic=_mimic(element),
    )


def _mimic(element: ET.Element) -> Mimic | None:
    """Return what a ``<joint>`` follows; one that cannot be read is as good as none."""
    with suppress(DescriptionError):
        return read_mimic(element.find("mimic"), "")
    return None


def _number(element: ET.Element | None, attribute: str) -> float | None:
    """Return a number that may be absent; one that cannot be read is as good as none."""
    with suppress(ValueError):
        return None if element is None else float(element.get(attribute, ""))
    return None
