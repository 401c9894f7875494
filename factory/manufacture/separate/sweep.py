"""How much deeper than at rest a joint drives hulls into one another."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from ...articulation import Articulation, Joint, JointKind
from ...asset import Hull
from ...mesh import FloatArray
from .along import hull_depth

#: Poses along a joint that are looked at.
POSES = 33


def swept_m(
    articulation: Articulation,
    hulls: Sequence[Sequence[Hull]],
    joint: Joint,
    enough_m: float = np.inf,
    gap_m: float = 0.0,
) -> float:
    """Return the worst deepening of any two parts along one joint, the others closed [m].

    An upper bound at the poses that are looked at: only face normals separate.

    Args:
        articulation: whose joint of that name is replaced by this one.
        hulls: per part, object frame at rest.
        joint: to be moved from lower to upper.
        enough_m: deeper than this is not looked into [m].
        gap_m: hulls nearer than this count as touching [m].
    """
    worst = 0.0
    for ones, others, poses in _ways(articulation, hulls, joint, POSES):
        worst = max(worst, _deepening(ones, others, poses, enough_m, gap_m)[0])
        if worst > enough_m:
            break
    return worst


def free_until(
    articulation: Articulation,
    hulls: Sequence[Sequence[Hull]],
    joint: Joint,
    free_m: float,
    gap_m: float,
) -> float:
    """Return how far a hinge turns from its lower end before two parts get deeper than free [rad].

    As many poses are looked at in each quarter turn as along any joint; the last free one counts.

    Args:
        articulation: whose joint of that name is replaced by this one.
        hulls: per part, object frame at rest.
        joint: to be turned.
        free_m: up to which a deepening counts as none [m].
        gap_m: hulls nearer than this count as touching [m].
    """
    quarters = max(1, int(np.ceil(joint.range / (np.pi / 2.0))))
    values = np.linspace(joint.lower, joint.upper, POSES * quarters)
    free = len(values)
    for ones, others, poses in _ways(articulation, hulls, joint, len(values)):
        free = min(free, _deepening(ones, others, poses[:free], free_m, gap_m)[1])
    return float(values[free - 1])


def _ways(
    articulation: Articulation, hulls: Sequence[Sequence[Hull]], joint: Joint, count: int
) -> Iterator[tuple[Sequence[Hull], Sequence[Hull], list[FloatArray]]]:
    """Yield hulls of two parts that move against one another, and the poses of the second."""
    joints = tuple(joint if each.name == joint.name else each for each in articulation.joints)
    tried = replace(articulation, joints=joints)
    moved = tried.carried(joint.child)
    # What has no ends has no closed one.
    closed = {j.name: j.lower for j in tried.movable_joints if j.kind is not JointKind.CONTINUOUS}
    poses = [
        tried.poses({**closed, **tried.together(joint, float(value))})
        for value in np.linspace(joint.lower, joint.upper, count)
    ]
    for a in (part for part in range(len(hulls)) if part not in moved):
        for b in moved:
            yield hulls[a], hulls[b], [np.linalg.inv(pose[a]) @ pose[b] for pose in poses]


def _deepening(
    ones: Sequence[Hull],
    others: Sequence[Hull],
    poses: list[FloatArray],
    enough_m: float,
    gap_m: float,
) -> tuple[float, int]:
    """Return how much deeper than at the first pose hulls of two parts get [m], see above.

    And how many poses were looked at before they got deeper than ``enough_m``.
    """
    if not ones or not others:
        return 0.0, len(poses)
    rest = hull_depth(ones, others, poses[0], gap_m) + gap_m
    worst = 0.0
    for number, pose in enumerate(poses[1:], start=1):
        worst = max(worst, hull_depth(ones, others, pose, gap_m) + gap_m - rest)
        if worst > enough_m:
            return worst, number
    return worst, len(poses)
