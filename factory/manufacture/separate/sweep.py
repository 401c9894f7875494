"""How much deeper than at rest a joint drives hulls into one another."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...articulation import Articulation, Joint
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
    joints = tuple(joint if each.name == joint.name else each for each in articulation.joints)
    tried = replace(articulation, joints=joints)
    moved = tried.carried(joint.child)
    closed = {each.name: each.lower for each in tried.movable_joints}
    poses = [
        tried.poses({**closed, joint.name: float(value)})
        for value in np.linspace(joint.lower, joint.upper, POSES)
    ]
    worst = 0.0
    for a in (part for part in range(len(hulls)) if part not in moved):
        for b in moved:
            relative = [np.asarray(np.linalg.inv(pose[a]) @ pose[b]) for pose in poses]
            worst = max(worst, _deepening(hulls[a], hulls[b], relative, enough_m, gap_m))
            if worst > enough_m:
                return worst
    return worst


def _deepening(
    ones: Sequence[Hull],
    others: Sequence[Hull],
    poses: list[FloatArray],
    enough_m: float,
    gap_m: float,
) -> float:
    """Return how much deeper than at the first pose hulls of two parts get [m], see above."""
    if not ones or not others:
        return 0.0
    rest = hull_depth(ones, others, poses[0], gap_m) + gap_m
    worst = 0.0
    for pose in poses[1:]:
        worst = max(worst, hull_depth(ones, others, pose, gap_m) + gap_m - rest)
        if worst > enough_m:
            break
    return worst
