"""Furniture made of boxes, as descriptions in memory: a sound cabinet and what breaks it."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from fault_corpus.things import at as frame_at
from fault_corpus.things import renewed, words
from ros_packages import SLIDE

from asset_factory.sim_checks.checks.lint import check_lint
from asset_factory.sim_checks.checks.penetration import check_penetration
from asset_factory.sim_checks.checks.result import CheckResult
from asset_factory.sim_checks.config import LintConfig, PenetrationConfig
from asset_factory.sim_checks.description import (
    DescribedShape,
    Description,
    JointLine,
    Link,
    LinkInertia,
)
from asset_factory.sim_checks.geometry.hull import CollisionHull, convex_hull
from asset_factory.sim_checks.geometry.kinematics import rotation_about
from asset_factory.sim_checks.geometry.placing import rigid
from asset_factory.sim_checks.read.primitives import box
from asset_factory.sim_checks.report import Finding

#: Centre and size [m].
Box = tuple[Sequence[float], Sequence[float]]


def box_hull(
    center: Sequence[float], size: Sequence[float], rotation: np.ndarray | None = None
) -> CollisionHull:
    vertices, _ = box(np.asarray(size, dtype=float))
    turned = vertices if rotation is None else vertices @ rotation.T
    return convex_hull(turned + np.asarray(center, dtype=float))


def box_shape(center: Sequence[float], size: Sequence[float], kind: str = "box") -> DescribedShape:
    vertices, faces = box(np.asarray(size, dtype=float))
    return DescribedShape("box", kind, vertices + np.asarray(center, dtype=float), faces)


def body(name: str, boxes: Sequence[Box], origin: Sequence[float] = (0.0, 0.0, 0.0)) -> Link:
    """A link of boxes given in the world's frame, whose own frame lies at ``origin``."""
    shapes = tuple(box_shape(np.subtract(center, origin), size) for center, size in boxes)
    points = np.vstack([shape.vertices for shape in shapes])
    extent = np.ptp(points, axis=0)
    tensor = 2.0 / 12.0 * np.diag([(extent**2).sum() - extent[i] ** 2 for i in range(3)])
    inertia = LinkInertia(2.0, (points.min(axis=0) + points.max(axis=0)) / 2.0, tensor)
    return Link(name, inertia, shapes, shapes)


def joint(
    name: str,
    kind: str,
    parent: str,
    child: str,
    at: Sequence[float],
    axis: Sequence[float],
    limits: tuple[float, float] | None,
    **more: Any,
) -> JointLine:
    """``at`` is the child's frame in the parent's."""
    along = np.asarray(axis, dtype=float)
    lower, upper = limits or (None, None)
    return JointLine(name, kind, parent, child, frame_at(*at), along, lower, upper, **more)


def described(links: Sequence[Link], joints: Sequence[JointLine]) -> Description:
    return Description(Path("boxes.urdf"), "urdf", tuple(links), tuple(joints))


#: Far below what moves.
BASE = body("base", [((0.0, 0.0, -1.0), (4.0, 4.0, 0.1))])


def sliding(
    name: str,
    boxes: Sequence[Box],
    axis: Sequence[float],
    upper: float,
    parent: str = "base",
    **more: Any,
) -> tuple[Link, JointLine]:
    """A link of boxes, and the slide of the same name that holds it, from 0 to ``upper`` [m]."""
    line = joint(name, "prismatic", parent, name, (0.0, 0.0, 0.0), axis, (0.0, upper), **more)
    return body(name, boxes), line


def turning(
    name: str,
    boxes: Sequence[Box],
    at: Sequence[float],
    axis: Sequence[float],
    upper: float,
    parent: str = "base",
    **more: Any,
) -> tuple[Link, JointLine]:
    """A link of boxes, and the hinge of the same name at a place, from 0 to ``upper`` [rad]."""
    line = joint(name, "revolute", parent, name, at, axis, (0.0, upper), **more)
    return body(name, boxes, at), line


def built(*moving: tuple[Link, JointLine], base: Link = BASE) -> Description:
    """What moves, and what carries it."""
    return described([base, *(link for link, _ in moving)], [line for _, line in moving])


def cabinet(defect: str = "none") -> Description:
    """A 0.6 x 0.4 x 0.8 m cabinet of 18 mm boards, gaps of 2 mm: overlay door above, drawer below.

    The front looks along -y. Defects: ``wide`` drawer 5 mm into both sides, ``axis_flip`` door
    opening inwards, ``hinge_inside`` hinge 20 mm inside the door's edge, ``sib`` fronts overlapping
    by 8 mm.
    """
    t = 0.018
    gap = 0.002
    carcass = [
        ((-0.291, 0.0, 0.4), (t, 0.4, 0.8)),
        ((0.291, 0.0, 0.4), (t, 0.4, 0.8)),
        ((0.0, 0.0, 0.009), (0.564, 0.4, t)),
        ((0.0, 0.0, 0.791), (0.564, 0.4, t)),
        ((0.0, 0.0, 0.4), (0.564, 0.4, t)),
        ((0.0, 0.191, 0.4), (0.564, t, 0.764)),
    ]
    half = 0.282 - gap + (0.007 if defect == "wide" else 0.0)
    back = 0.182 - gap
    front = -0.2 - gap
    drawer = [
        ((-half + t / 2, (front + back) / 2, 0.2), (t, back - front, 0.3)),
        ((half - t / 2, (front + back) / 2, 0.2), (t, back - front, 0.3)),
        ((0.0, back - t / 2, 0.2), (2 * half - 2 * t, t, 0.3)),
        ((0.0, (front + back) / 2, 0.059), (2 * half - 2 * t, back - front - 2 * t, t)),
        ((0.0, front - t / 2, 0.2), (0.6, t, 0.396)),
    ]
    low = 0.402 - gap + (-0.008 if defect == "sib" else gap) - gap
    hinge_x = -0.3 + (0.02 if defect == "hinge_inside" else 0.0)
    hinge = (hinge_x, front, 0.6)
    door = [((0.0, front - t / 2, (low + 0.8) / 2), (0.6, t, 0.8 - low))]
    outwards = (0.0, 0.0, 1.0 if defect == "axis_flip" else -1.0)
    out = (0.0, -1.0, 0.0)
    links = [body("carcass", carcass), body("drawer", drawer), body("door", door, hinge)]
    joints = [
        joint("slide", "prismatic", "carcass", "drawer", (0.0, 0.0, 0.0), out, (0.0, 0.3)),
        joint("hinge", "revolute", "carcass", "door", hinge, outwards, (0.0, 1.57)),
    ]
    return described(links, joints)


def chain(links: int) -> Description:
    """Boxes in a row, each on a hinge at the end of the one before, 2 mm apart."""
    pitch = 0.102
    bodies = [
        body(f"l{i}", [((pitch * i + 0.05, 0.0, 0.0), (0.1, 0.05, 0.05))], (pitch * i, 0.0, 0.0))
        for i in range(links)
    ]
    turn = ((pitch, 0, 0), (0.0, 0.0, 1.0), (0.0, 0.02))
    hinges = [joint(f"j{i}", "revolute", f"l{i - 1}", f"l{i}", *turn) for i in range(1, links)]
    return described(bodies, hinges)


def keyboard(keys: int) -> Description:
    """Keys in a row, 2 mm apart, that go down into nothing."""
    places = [((0.02 * i, 0.0, 0.0), (0.018, 0.018, 0.01)) for i in range(keys)]
    down = (0.0, 0.0, -1.0)
    return built(*(sliding(f"k{i}", [place], down, 0.004) for i, place in enumerate(places)))


def random_pose(seed: int) -> np.ndarray:
    """A rigid motion, shape [4, 4]."""
    generator = np.random.default_rng(seed)
    axis = generator.normal(size=3)
    turn = rotation_about(axis / np.linalg.norm(axis), generator.uniform(0.0, 6.0))
    return rigid(turn, generator.normal(size=3))


def with_joint(description: Description, name: str, **changes: object) -> Description:
    return replace(description, joints=renewed(description.joints, name, **changes))


def with_link(description: Description, name: str, **changes: object) -> Description:
    return replace(description, links=renewed(description.links, name, **changes))


def linted(description: Description, code: str = "") -> list[Finding]:
    """What the lint finds by a code that begins so."""
    found = check_lint(description, LintConfig()).findings
    return [finding for finding in found if finding.code.startswith(code)]


def penetrating(description: Description, **limits: Any) -> CheckResult:
    """What the penetration check says, with other limits than the usual."""
    return check_penetration(description, PenetrationConfig(**limits))


def write_drawer(path: Path, gap: float) -> Path:
    """A URDF of a shell and a drawer that slides past it, so far apart [m]."""
    size = (0.4, 0.2, 0.2)
    boxes = {"shell": ((0, 0, 0), size), "drawer": ((0, 0.2 + gap, 0), size)}
    path.parent.mkdir(parents=True, exist_ok=True)
    return write_urdf(path.parent, boxes, SLIDE).rename(path)


def joint_text(
    child: str, axis: str, upper: float, parent: str = "base", kind: str = "prismatic"
) -> str:
    """What holds a link on its parent in a URDF, from 0 to ``upper``."""
    limits = f'lower="0" upper="{upper}" effort="1" velocity="1"'
    return (
        f'<joint name="{child}_joint" type="{kind}"><parent link="{parent}"/>'
        f'<child link="{child}"/><axis xyz="{axis}"/><limit {limits}/></joint>'
    )


def write_urdf(folder: Path, boxes: Mapping[str, Box], joints: str) -> Path:
    """A URDF whose links are single primitive boxes in their own frames."""
    links = "".join(
        f'<link name="{name}"><inertial><origin xyz="{words(center)}"/><mass value="1"/>'
        '<inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>'
        f'<collision><origin xyz="{words(center)}"/><geometry><box size="{words(size)}"/>'
        "</geometry></collision>"
        "</link>"
        for name, (center, size) in boxes.items()
    )
    path = folder / "boxes.urdf"
    path.write_text(f'<robot name="boxes">{links}{joints}</robot>')
    return path
