"""What gravity pulls at a joint that stands still, by the description's own masses."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ..description import Description, JointLine, sensible
from .kinematics import Tree, unit_axis

#: [m/s2]; z is up.
GRAVITY = 9.81


def gravity_load(
    description: Description, tree: Tree, joint: JointLine, values: Mapping[str, float]
) -> float | None:
    """Return the force that gravity moves a joint with, root fixed [N m] or [N].

    Joints whose ``values`` [rad] or [m] are left out are at 0, or where their leaders take them.

    Returns:
        Positive where it pulls towards upper; ``None`` where a visible or solid link that moves
        with the joint has no usable mass.
    """
    poses = tree.link_poses(values)
    below = tree.below(joint)
    frame = poses[joint.child]
    axis = frame[:3, :3] @ unit_axis(joint)
    total = 0.0
    for link in description.links:
        if link.name not in below:
            continue
        if link.inertia is None:
            if link.collisions or link.visuals:
                return None
            continue
        if not (sensible(link.inertia.mass) and sensible(link.inertia.center)):
            return None
        pose = poses[link.name]
        arm = pose[:3, :3] @ link.inertia.center + pose[:3, 3] - frame[:3, 3]
        lift = axis if joint.kind == "prismatic" else np.cross(axis, arm)
        total -= link.inertia.mass * GRAVITY * float(lift[2])
    return total
