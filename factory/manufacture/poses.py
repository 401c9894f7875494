"""Where two parts are as seen from one another, along the joints between them."""

from __future__ import annotations

import numpy as np

from ..articulation import Articulation, Joint
from ..mesh import FloatArray


def relative_poses(articulation: Articulation, a: int, b: int, count: int) -> list[FloatArray]:
    """Where part ``b`` is as seen from ``a``, [4, 4] each.

    As modelled, closed, and along each joint between them.

    Args:
        articulation: parts and joints.
        a: index of a part.
        b: of another.
        count: poses along each joint.
    """
    lower = {joint.name: joint.lower for joint in articulation.movable_joints}
    values: list[dict[str, float]] = [{}, lower]
    for joint in joints_between(articulation, a, b):
        values += [
            {**lower, joint.name: float(q)}
            for q in np.linspace(joint.lower, joint.upper, count)[1:]
        ]
    relative = []
    for given in values:
        poses = articulation.poses(given)
        relative.append(np.asarray(np.linalg.inv(poses[a]) @ poses[b]))
    return relative


def joints_between(articulation: Articulation, a: int, b: int) -> list[Joint]:
    """The joints that move one of two parts and not the other."""

    def above(part: int) -> set[str]:
        names: set[str] = set()
        joint = articulation.parent_joint(part)
        while joint is not None:
            names.add(joint.name)
            joint = articulation.parent_joint(joint.parent)
        return names

    between = above(a) ^ above(b)
    return [joint for joint in articulation.movable_joints if joint.name in between]


def jointed(articulation: Articulation, a: int, b: int) -> bool:
    """Whether one joint holds one of two parts in the other."""
    return any({joint.parent, joint.child} == {a, b} for joint in articulation.joints)
