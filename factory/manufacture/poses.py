"""Where two parts are as seen from one another, along the joints between them."""

from __future__ import annotations

import numpy as np

from ..articulation import Articulation, Joint
from ..mesh import FloatArray

#: Beyond a turn of so many quarters poses grow sparser.
MOST_QUARTERS = 2.0


def relative_poses(
    articulation: Articulation, a: int, b: int, count: int, share: float = 1.0
) -> list[FloatArray]:
    """Return where part ``b`` is as seen from ``a``: as modelled, closed, and as joints move it.

    That is at ``count`` poses, [4, 4] each, along each joint between them, in a ``share`` of its
    range from its lower end; along a hinge that turns further than a quarter turn at so many in
    each quarter.
    """
    lower = {joint.name: joint.lower for joint in articulation.movable_joints}
    values: list[dict[str, float]] = [{}, lower]
    for joint in joints_between(articulation, a, b):
        quarters = joint.range / (np.pi / 2.0) if joint.turns else 1.0
        steps = int(np.ceil((count - 1) * min(max(quarters, 1.0), MOST_QUARTERS)))
        values += [
            {**lower, **articulation.together(joint, float(q))}
            for q in np.linspace(joint.lower, joint.lower + share * joint.range, steps + 1)[1:]
        ]
    # Of these two alone: a keyboard has a hundred parts, each of which asks about all others.
    above_a, above_b = (joints_above(articulation, part)[::-1] for part in (a, b))
    return [
        np.asarray(np.linalg.inv(_pose(above_a, given)) @ _pose(above_b, given)) for given in values
    ]


def moved(points: FloatArray, pose: FloatArray) -> FloatArray:
    """Return points [m], shape [n, 3], moved by a pose, shape [4, 4]."""
    return np.asarray(points @ pose[:3, :3].T + pose[:3, 3])


def arms_from(joint: Joint, points: FloatArray) -> FloatArray:
    """Return the arms from a joint's axis to points [m], shape [n, 3], across the axis."""
    arms = points - joint.origin
    return np.asarray(arms - np.outer(arms @ joint.axis, joint.axis))


def joints_between(articulation: Articulation, a: int, b: int) -> list[Joint]:
    """Return the joints that move one of two parts and not the other."""
    above_a, above_b = ({j.name for j in joints_above(articulation, part)} for part in (a, b))
    between = above_a ^ above_b
    return [joint for joint in articulation.movable_joints if joint.name in between]


def joints_above(articulation: Articulation, part: int) -> list[Joint]:
    """Return the joints from the one that holds a part up to the root's."""
    found = []
    joint = articulation.parent_joint(part)
    while joint is not None:
        found.append(joint)
        joint = articulation.parent_joint(joint.parent)
    return found


def _pose(joints: list[Joint], values: dict[str, float]) -> FloatArray:
    """Return the motion from rest of what hangs on joints from the root down, [4, 4]."""
    pose = np.eye(4)
    for joint in joints:
        pose = pose @ joint.motion(values.get(joint.name, 0.0))
    return pose


def held_by(articulation: Articulation, part: int) -> int | None:
    """Return the next part above one that has a body; ``None`` if there is none."""
    holders = (joint.parent for joint in joints_above(articulation, part))
    return next((part for part in holders if len(articulation.parts[part].faces)), None)
