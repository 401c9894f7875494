"""URDF: links, joints and visuals, posed with every joint at zero.

The format: http://wiki.ros.org/urdf/XML. What is allowed here and not there: several ``<visual>``
of one name, several ``<inertial>`` (neither matters to the lift), and ``<capsule>``.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from ...config import IntakeConfig
from ...errors import InputRejected
from ...mesh import FloatArray, Mesh
from ...runtime.store import digest_file
from ..annotation import AnnotatedJoint
from ..limits import require_at_most
from .imported import Imported, rigid, rigid_groups
from .urdf_appearance import Palette, painted
from .urdf_geometry import GeometryReader
from .xml_source import numbers

MOVING = ("revolute", "continuous", "prismatic")
MAX_LINKS = 4096
MAX_SHAPES = 10_000


@dataclass(frozen=True)
class _UrdfJoint:
    name: str
    kind: str
    parent: int
    child: int
    origin: FloatArray
    axis: FloatArray
    lower: float | None
    upper: float | None
    damping: float | None
    friction: float | None


def import_urdf(robot: ET.Element, path: Path, config: IntakeConfig) -> Imported:
    """Return every link's visuals and every joint of a URDF, in the root link's frame.

    Args:
        robot: the ``<robot>`` element.
        path: the file it came from; what it refers to lies in or below that file's folder.
        config: limits on the files it refers to.

    Raises:
        InputRejected: ``not_a_tree``, ``unsupported_joint``, ``missing_file``,
            ``external_reference``, ``unreadable``, ``too_large``.
    """
    links = robot.findall("link")
    for what, elements in (("links", links), ("joints", robot.findall("joint"))):
        require_at_most(path.name, len(elements), MAX_LINKS, what)
    names = tuple(link.get("name", "") for link in links)
    _refuse_repeats(names, path.name)
    index_of = {name: index for index, name in enumerate(names)}
    joints = [_joint(e, index_of, path.name) for e in robot.findall("joint")]
    order = _root_first(names, joints, path.name)
    poses = _poses_at_zero(len(names), joints, order)
    notes = _notes(robot, joints)
    reader = GeometryReader(path.parent, config)
    palette = Palette(robot, path.parent, config)
    welds = [(j.parent, j.child) for j in joints if j.kind == "fixed"]
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
            posed = painted(mesh, element, palette, where).transformed(
                poses[part] @ origin_of(element, where)
            )
            pieces.append((part, posed))
    return Imported(
        pieces=tuple(pieces),
        part_names=names,
        joints=tuple(_annotated(j, poses) for j in joints),
        digests=(digest_file(path), *reader.digests, palette.digest),
        notes=(*notes, *reader.notes),
        source="urdf",
        licenses=reader.licenses,
        dropped_degenerate=reader.dropped_degenerate,
        dropped_non_finite=reader.dropped_non_finite,
    )


def origin_of(element: ET.Element, where: str) -> FloatArray:
    """The pose in an element's ``<origin xyz rpy>``, shape [4, 4]; fixed-axis roll, pitch, yaw."""
    origin = element.find("origin")
    if origin is None:
        return np.eye(4)
    xyz = numbers(origin.get("xyz"), 3, (0.0, 0.0, 0.0), f"{where}: <origin xyz>")
    rpy = numbers(origin.get("rpy"), 3, (0.0, 0.0, 0.0), f"{where}: <origin rpy>")
    return rigid(Rotation.from_euler("xyz", rpy).as_matrix(), xyz)


def _refuse_repeats(names: tuple[str, ...], file: str) -> None:
    if not names:
        raise InputRejected("not_a_tree", f"{file}: has no <link>, want at least one")
    repeated = sorted(name for name, count in Counter(names).items() if count > 1)
    if repeated:
        raise InputRejected(
            "not_a_tree", f"{file}: two links are called {repeated[0]!r}; want unique names"
        )


def _joint(element: ET.Element, index_of: Mapping[str, int], file: str) -> _UrdfJoint:
    name = element.get("name", "")
    where = f"{file}: joint {name!r}"
    kind = element.get("type", "")
    if kind == "planar" or kind not in (*MOVING, "fixed", "floating"):
        raise InputRejected(
            "unsupported_joint",
            f"{where}: is of type {kind!r}; want fixed, revolute, continuous or prismatic",
        )
    ends = []
    for role in ("parent", "child"):
        found = element.find(role)
        link = "" if found is None else found.get("link", "")
        if link not in index_of:
            raise InputRejected(
                "not_a_tree", f"{where}: its {role} link {link!r} is not in the file"
            )
        ends.append(index_of[link])
    axis = element.find("axis")
    limit = element.find("limit")
    dynamics = element.find("dynamics")
    lower, upper = _limits(limit, kind, where)
    return _UrdfJoint(
        name=name,
        kind=kind,
        parent=ends[0],
        child=ends[1],
        origin=origin_of(element, where),
        axis=numbers(
            None if axis is None else axis.get("xyz"), 3, (1.0, 0.0, 0.0), f"{where}: <axis xyz>"
        ),
        lower=lower,
        upper=upper,
        damping=_number(dynamics, "damping"),
        friction=_number(dynamics, "friction"),
    )


def _limits(limit: ET.Element | None, kind: str, where: str) -> tuple[float | None, float | None]:
    if kind not in ("revolute", "prismatic") or limit is None:
        return None, None
    if limit.get("lower") is None and limit.get("upper") is None:
        return None, None
    ends = []
    for end in ("lower", "upper"):
        text = limit.get(end, "0")
        try:
            ends.append(float(text))
        except ValueError as error:
            raise InputRejected(
                "unreadable", f"{where}: <limit {end}> is {text!r}, want a number"
            ) from error
    return ends[0], ends[1]


def _number(element: ET.Element | None, attribute: str) -> float | None:
    try:
        return None if element is None else float(element.get(attribute, ""))
    except ValueError:
        return None


def _root_first(names: tuple[str, ...], joints: list[_UrdfJoint], file: str) -> list[_UrdfJoint]:
    """The joints, parents before children. Raises InputRejected ``not_a_tree`` naming the links."""
    holder: dict[int, _UrdfJoint] = {}
    for joint in joints:
        if joint.child in holder:
            raise InputRejected(
                "not_a_tree",
                f"{file}: link {names[joint.child]!r} is the child of joints "
                f"{holder[joint.child].name!r} and {joint.name!r}; want one",
            )
        holder[joint.child] = joint
    roots = [i for i in range(len(names)) if i not in holder]
    if len(roots) > 1:
        listed = ", ".join(repr(names[i]) for i in roots[:5])
        raise InputRejected(
            "not_a_tree",
            f"{file}: {len(roots)} links have no parent ({listed}); want one root",
            value=len(roots),
        )
    ordered: list[_UrdfJoint] = []
    reached = set(roots)
    while len(ordered) < len(joints):
        ready = [j for j in joints if j.parent in reached and j.child not in reached]
        if not ready:
            stuck = ", ".join([repr(names[i]) for i in range(len(names)) if i not in reached][:5])
            raise InputRejected(
                "not_a_tree", f"{file}: links {stuck} form a cycle; want one tree from one root"
            )
        ordered += ready
        reached |= {j.child for j in ready}
    return ordered


def _poses_at_zero(count: int, joints: list[_UrdfJoint], ordered: list[_UrdfJoint]) -> FloatArray:
    poses = np.tile(np.eye(4), (count, 1, 1))
    for joint in ordered:
        poses[joint.child] = poses[joint.parent] @ joint.origin
    return poses


def _choose_shapes(
    links: list[ET.Element], groups: list[int], notes: list[str]
) -> list[tuple[int, ET.Element]]:
    """Visuals; for links welded together that have none, their collision shapes."""
    seen = {groups[part] for part, link in enumerate(links) if link.find("visual") is not None}
    chosen: list[tuple[int, ET.Element]] = []
    for part, link in enumerate(links):
        visuals = link.findall("visual")
        collisions = link.findall("collision")
        if groups[part] not in seen and collisions:
            notes.append(
                f"link {link.get('name')!r} has no visual geometry; its collision geometry is used"
            )
            visuals = collisions
        chosen += [(part, shape) for shape in visuals]
    return chosen


def _notes(robot: ET.Element, joints: list[_UrdfJoint]) -> list[str]:
    notes = []
    for element in robot.findall("joint"):
        mimic = element.find("mimic")
        if mimic is not None:
            notes.append(
                f"joint {element.get('name')!r} mimics {mimic.get('joint')!r} in the file; "
                "the mimic is ignored, it moves freely"
            )
    notes += [
        f"joint {j.name!r} is floating in the file; its link is held fixed"
        for j in joints
        if j.kind == "floating"
    ]
    commas = {
        element.tag
        for element in robot.iter()
        if any("," in element.get(name, "") for name in ("scale", "size", "xyz", "rpy"))
    }
    if commas:
        notes.append(f"commas between numbers are read as spaces: {', '.join(sorted(commas))}")
    return notes


def _annotated(joint: _UrdfJoint, poses: FloatArray) -> AnnotatedJoint:
    frame = poses[joint.child]
    return AnnotatedJoint(
        name=joint.name,
        kind=joint.kind if joint.kind in MOVING else "fixed",
        parent=joint.parent,
        child=joint.child,
        axis=frame[:3, :3] @ joint.axis,
        origin=frame[:3, 3].copy(),
        lower=joint.lower,
        upper=joint.upper,
        damping=joint.damping,
        friction=joint.friction,
    )
