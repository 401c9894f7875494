"""How far a slab can turn before it meets the rest: surrounding points against turned boxes."""

from __future__ import annotations

import numpy as np

from ...articulation import rotation_about
from ...geometry.triangles import doubled_normals, points_within
from ...mesh import FloatArray, IntArray
from .scene import Scene

STEP = np.radians(5.0)


def surface_points(scene: Scene, most: int = 20000) -> tuple[FloatArray, IntArray]:
    """Return the corners and evenly spread points of the surface, always the same.

    Returns:
        Positions [m], shape [point_count, 3], and the piece of each, shape [point_count].
    """
    triangles = scene.triangles
    area = np.linalg.norm(doubled_normals(triangles), axis=1)
    count = np.floor(area / max(float(area.sum()), 1e-300) * most).astype(np.int64)
    owner = np.repeat(np.arange(len(triangles)), count)
    rng = np.random.default_rng(0)
    inner = points_within(triangles[owner], *rng.random((2, len(owner))))
    stride = max(1, len(triangles) * 3 // most)
    corners = triangles.reshape(-1, 3)[::stride]
    corner_owner = np.repeat(scene.labels, 3)[::stride]
    return np.concatenate([corners, inner]), np.concatenate([corner_owner, scene.labels[owner]])


def free_turn(
    points: FloatArray, box: FloatArray, axis: FloatArray, origin: FloatArray, limit: float
) -> float:
    """Return the largest angle [rad] up to ``limit`` that a box turns without swallowing a point.

    Args:
        points: surroundings [m], shape [n, 3].
        box: lower and upper corner [m], shape [2, 3]; shrunk by the caller so that contacts at rest
            are free.
        axis: unit direction, turning by the right-hand rule.
        origin: a point on the axis [m].
        limit: where to stop [rad].

    Points inside the box at rest are ignored: what overlaps already is not met by turning.
    """
    low, high = box
    outside = ~((points > low) & (points < high)).all(axis=1)
    reach = np.linalg.norm(box - origin, axis=1).max() * np.sqrt(3.0)
    near = outside & (np.abs(points - origin) <= reach).all(axis=1)
    relative = points[near] - origin
    box_low = low - origin
    box_high = high - origin
    angles = np.arange(1, round(limit / STEP) + 1) * STEP
    for k, angle in enumerate(angles):
        back = relative @ rotation_about(axis, -float(angle)).T
        if ((back > box_low) & (back < box_high)).all(axis=1).any():
            return float(angles[k - 1]) if k else 0.0
    return float(limit)
