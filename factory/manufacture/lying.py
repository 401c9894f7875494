"""Which part another one lies on: a handle that is no part of its own belongs to its door."""

from collections.abc import Collection

import numpy as np
from scipy.spatial import cKDTree

from ..articulation import Articulation
from ..mesh import FloatArray
from .separate.budget import SeenSurface

#: What is no further off than this share of the object's diagonal is lain on.
NEAR_SHARE = 0.03


def lying_on(articulation: Articulation, joints: Collection[str]) -> dict[str, int]:
    """Return by joint the part that most of its own part's surface lies near, if any.

    Args:
        articulation: parts and joints, as modelled.
        joints: names; parts that carry others are left out, and none lies on a part of these.
    """
    leaving = {joint.child for joint in articulation.joints if joint.name in joints}
    carriers = {joint.parent for joint in articulation.joints}
    shown = {
        index: SeenSurface.of(articulation.part_mesh(index)).points
        for index, part in enumerate(articulation.parts)
        if len(part.faces)
    }
    others = {index: points for index, points in shown.items() if index not in leaving}
    near = NEAR_SHARE * articulation.mesh.diagonal
    found = {}
    for joint in articulation.joints:
        if joint.name in joints and joint.child in shown and joint.child not in carriers:
            nearest = _nearest(shown[joint.child], others, near)
            if nearest is not None:
                found[joint.name] = nearest
    return found


def _nearest(points: FloatArray, others: dict[int, FloatArray], near: float) -> int | None:
    """Return which of some parts is the nearest of most points [m], shape [n, 3]."""
    if not others:
        return None
    distances = np.array([cKDTree(other).query(points)[0] for other in others.values()])
    touching = distances.min(axis=0) < near
    if not touching.any():
        return None
    counts = np.bincount(distances.argmin(axis=0)[touching], minlength=len(others))
    return list(others)[int(counts.argmax())]
