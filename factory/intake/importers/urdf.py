"""URDF: links, joints and visuals, posed with every joint at zero.

The format: http://wiki.ros.org/urdf/XML. Allowed here and not there: several ``<visual>``
of one name, several ``<inertial>`` (neither matters to an import), and ``<capsule>``.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections import Counter
from contextlib import suppress
from pathlib import Path

import numpy as np

from asset_factory.sim_checks.description import DescriptionError, FloatArray, JointLine, Mimic
from asset_factory.sim_checks.geometry.kinematics import MOVING_KINDS
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
    _refuse_repeats(names, path.name)
    known = frozenset(names)
    joints = [_joint(element, known, path.name) for element in robot.findall("joint")]
    poses = {name: np.eye(4) for name in names}
    for joint in _root_first(names, joints, path.name):
        poses[joint.child] = poses[joint.parent] @ joint.origin
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


def _refuse_repeats(names: tuple[str, ...], file: str) -> None:
    if not names:
        raise _no_tree(file, "has no <link>, want at least one")
    repeated = sorted(name for name, count in Counter(names).items() if count > 1)
    if repeated:
        raise _no_tree(file, f"two links are called {repeated[0]!r}; want unique names")


def _no_tree(where: str, why: str, value: float | None = None) -> InputRejected:
    return InputRejected("not_a_tree", f"{where}: {why}", value=value)


def _joint(element: ET.Element, links: frozenset[str], file: str) -> JointLine:
    joint = LENIENT.joint(element)
    where = f"{file}: joint {joint.name!r}"
    if joint.kind not in (*MOVING_KINDS, "fixed", "floating"):
        want = "want fixed, revolute, continuous or prismatic"
        why = f"{where}: is of type {joint.kind!r}; {want}"
        raise InputRejected("unsupported_joint", why)
    for role, link in (("parent", joint.parent), ("child", joint.child)):
        if link not in links:
            raise _no_tree(where, f"its {role} link {link!r} is not in the file")
    return joint


def _root_first(names: tuple[str, ...], joints: list[JointLine], file: str) -> list[JointLine]:
    """Return the joints, parents first. Raises InputRejected ``not_a_tree`` naming the links."""
    holder: dict[str, JointLine] = {}
    for joint in joints:
        if joint.child in holder:
            both = f"joints {holder[joint.child].name!r} and {joint.name!r}"
            raise _no_tree(file, f"link {joint.child!r} is the child of {both}; want one")
        holder[joint.child] = joint
    roots = [name for name in names if name not in holder]
    if len(roots) > 1:
        listed = ", ".join(repr(name) for name in roots[:5])
        why = f"{len(roots)} links have no parent ({listed}); want one root"
        raise _no_tree(file, why, len(roots))
    ordered: list[JointLine] = []
    reached = set(roots)
    while len(ordered) < len(joints):
        ready = [j for j in joints if j.parent in reached and j.child not in reached]
        if not ready:
            stuck = ", ".join([repr(name) for name in names if name not in reached][:5])
            raise _no_tree(file, f"links {stuck} form a cycle; want one tree from one root")
        ordered += ready
        reached |= {j.child for j in ready}
    return ordered


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
