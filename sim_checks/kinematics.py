"""Where every link is for given joint values: the judge's own forward kinematics."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from .description import Description, FloatArray, JointLine

MOVING_KINDS = ("revolute", "continuous", "prismatic")


class NotATree(ValueError):
    """The joints do not hang every link, once, below one root."""


@dataclass(frozen=True)
class Tree:
    """The joints in an order that visits parents first.

    Attributes:
        root: the one link that is no joint's child.
        order: all joints, parents first.
        moving: those of ``order`` that move, in file order.
        parts: links that no moving joint separates, as tuples of link names in file order; the root's part first.
    """

    root: str
    order: tuple[JointLine, ...]
    moving: tuple[JointLine, ...]
    parts: tuple[tuple[str, ...], ...]

    def link_poses(self, values: Mapping[str, float]) -> dict[str, FloatArray]:
        """Link frames in the root's frame, each of shape [4, 4].

        Args:
            values: joint name -> value [rad] or [m]; joints left out are at 0.
        """
        poses: dict[str, FloatArray] = {self.root: np.eye(4)}
        for joint in self.order:
            poses[joint.child] = poses[joint.parent] @ joint.origin @ joint_motion(joint, values.get(joint.name, 0.0))
        return poses

    def below(self, joint: JointLine) -> frozenset[str]:
        """Names of the links that move with ``joint``."""
        found = {joint.child}
        for other in self.order:
            if other.parent in found:
                found.add(other.child)
        return frozenset(found)

    def part_of(self) -> dict[str, int]:
        """Link name -> index into ``parts``."""
        return {link: index for index, part in enumerate(self.parts) for link in part}


def build_tree(description: Description) -> Tree:
    """Hang every link below one root.

    Raises:
        NotATree: with the links at fault.
    """
    names = [link.name for link in description.links]
    children = [joint.child for joint in description.joints]
    known = set(names)
    strangers = {end for joint in description.joints for end in (joint.parent, joint.child)} - known
    if strangers:
        raise NotATree(f"joints name links that are not there: {', '.join(sorted(strangers))}")
    if len(known) != len(names):
        raise NotATree(f"{len(names) - len(known)} link names are used twice")
    if len(set(children)) != len(children):
        raise NotATree("a link is the child of two joints")
    roots = [name for name in names if name not in set(children)]
    if len(roots) != 1:
        raise NotATree(f"{len(roots)} root links ({', '.join(roots[:5])}), want 1")
    order = _parents_first(roots[0], description.joints)
    if len(order) != len(description.joints):
        raise NotATree(f"{len(description.joints) - len(order)} joints form a loop apart from root {roots[0]!r}")
    moving = tuple(joint for joint in description.joints if joint.kind in MOVING_KINDS)
    return Tree(roots[0], order, moving, _parts(names, roots[0], order))


def _parents_first(root: str, joints: tuple[JointLine, ...]) -> tuple[JointLine, ...]:
    by_parent: dict[str, list[JointLine]] = {}
    for joint in joints:
        by_parent.setdefault(joint.parent, []).append(joint)
    order: list[JointLine] = []
    queue = [root]
    while queue:
        for joint in by_parent.get(queue.pop(0), []):
            order.append(joint)
            queue.append(joint.child)
    return tuple(order)


def _parts(names: list[str], root: str, order: tuple[JointLine, ...]) -> tuple[tuple[str, ...], ...]:
    head = {root: root}
    for joint in order:
        head[joint.child] = joint.child if joint.kind in MOVING_KINDS else head[joint.parent]
    heads = [root, *(name for name in names if name != root and head[name] == name)]
    return tuple(tuple(name for name in names if head[name] == first) for first in heads)


def joint_motion(joint: JointLine, value: float) -> FloatArray:
    """What the joint adds to its origin at ``value`` [rad] or [m]; shape [4, 4]."""
    pose = np.eye(4)
    axis = unit_axis(joint)
    if joint.kind == "prismatic":
        pose[:3, 3] = value * axis
    elif joint.kind in ("revolute", "continuous"):
        pose[:3, :3] = rotation_about(axis, value)
    return pose


def unit_axis(joint: JointLine) -> FloatArray:
    """The joint's axis at length 1; x where it is zero, as loaders take it."""
    length = float(np.linalg.norm(joint.axis))
    return joint.axis / length if length > 1e-12 else np.array([1.0, 0.0, 0.0])


def rotation_about(axis: FloatArray, angle: float) -> FloatArray:
    """Rodrigues' rotation by ``angle`` [rad] about a unit axis; shape [3, 3]."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    rotation: FloatArray = np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * (cross @ cross)
    return rotation


def sweep_range(joint: JointLine) -> tuple[float, float] | None:
    """From where to where a joint is swept; a revolute joint without limits makes one turn.

    ``None`` where there is nothing to sweep: a slide without limits, or limits that are not finite or not ordered.
    """
    if joint.lower is None or joint.upper is None:
        return None if joint.kind == "prismatic" else (0.0, 2.0 * np.pi)
    if not (np.isfinite(joint.lower) and np.isfinite(joint.upper) and joint.lower < joint.upper):
        return None
    if joint.kind != "prismatic" and joint.upper - joint.lower > 2.0 * np.pi:
        return joint.lower, joint.lower + 2.0 * np.pi
    return joint.lower, joint.upper
