"""How much deeper than at rest a joint drives hulls into one another."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from ...articulation import Joint
from ...asset import Asset, Hull
from ...geometry.posing import closed_values
from ...mesh import FloatArray
from .along import hull_depth

#: Poses along a joint that are looked at.
POSES = 33


def swept_m(asset: Asset, joint: Joint, enough_m: float = np.inf, gap_m: float = 0.0) -> float:
    """Return the worst deepening of any two parts along one joint, the others closed [m].

    An upper bound at the poses that are looked at: only face normals separate. Deeper than
    ``enough_m`` is not looked into, and hulls nearer than ``gap_m`` count as touching [m]. The
    joint stands for the asset's of its name.
    """
    worst = 0.0
    for ones, others, poses in _ways(asset, joint, POSES):
        for deeper in _deepening(ones, others, poses, gap_m):
            worst = max(worst, deeper)
            if worst > enough_m:
                return worst
    return worst


def free_until(asset: Asset, joint: Joint, passed_m: float, free_m: float, gap_m: float) -> float:
    """Return where a hinge is free last before it runs into something [rad], from lower on.

    As many poses are looked at in each quarter turn as along any joint. Deeper than ``passed_m``
    two parts do not pass one another; where the hinge ends they are no deeper than ``free_m``;
    hulls nearer than ``gap_m`` count as touching [m].
    """
    quarters = max(1, int(np.ceil(joint.range / (np.pi / 2.0))))
    values = np.linspace(joint.lower, joint.upper, POSES * quarters)
    deepest = np.zeros(len(values))
    for ones, others, poses in _ways(asset, joint, len(values)):
        for number, deeper in enumerate(_deepening(ones, others, poses, gap_m)):
            deepest[number] = max(deepest[number], deeper)
            if deeper > passed_m:
                deepest = deepest[:number]
            if number >= len(deepest) - 1:
                break
    return float(values[np.flatnonzero(deepest <= free_m)[-1]])


def _ways(
    asset: Asset, joint: Joint, count: int
) -> Iterator[tuple[Sequence[Hull], Sequence[Hull], list[FloatArray]]]:
    """Yield hulls of two parts that move against one another, and the poses of the second."""
    joints = asset.articulation.joints
    joints = tuple(joint if each.name == joint.name else each for each in joints)
    tried = replace(asset.articulation, joints=joints)
    moved = tried.carried(joint.child)
    closed = closed_values(tried)
    poses = [
        tried.poses({**closed, **tried.together(joint, float(value))})
        for value in np.linspace(joint.lower, joint.upper, count)
    ]
    hulls = [body.hulls for body in asset.bodies]
    for a in (part for part in range(len(hulls)) if part not in moved):
        for b in moved:
            yield hulls[a], hulls[b], [np.linalg.inv(pose[a]) @ pose[b] for pose in poses]


def _deepening(
    ones: Sequence[Hull], others: Sequence[Hull], poses: list[FloatArray], gap_m: float
) -> Iterator[float]:
    """Yield how much deeper hulls of two parts are at each pose than at the first [m]."""
    rest = hull_depth(ones, others, poses[0], gap_m)
    yield 0.0
    for pose in poses[1:]:
        yield hull_depth(ones, others, pose, gap_m) - rest
