"""How far points lie outside convex hulls, exactly."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.spatial import cKDTree

from ...asset import Hull
from ...mesh import FloatArray
from .convex import depth_below

#: Points measured at a time, which bounds memory.
BLOCK = 1024
#: What lies no further beyond a plane is on it but for rounding [m].
ROUNDING_M = 1e-12


def outside(hulls: Sequence[Hull], points: FloatArray) -> FloatArray:
    """Return how far each point lies outside all hulls [m], shape [n]; zero within one.

    Args:
        hulls: infinitely far away where there are none.
        points: [m], shape [n, 3].
    """
    if not hulls:
        return np.full(len(points), np.inf)
    corners = cKDTree(np.concatenate([hull.vertices for hull in hulls]))
    blocks = [points[start : start + BLOCK] for start in range(0, len(points), BLOCK)]
    return np.concatenate([np.zeros(0), *(_outside(hulls, corners, block) for block in blocks)])


def uncovered(hulls: Sequence[Hull], points: FloatArray) -> float:
    """How far the worst of ``points`` lies outside all hulls [m]; zero if none does."""
    return float(outside(hulls, points).max(initial=0.0))


def _outside(hulls: Sequence[Hull], corners: cKDTree, points: FloatArray) -> FloatArray:
    """The same of a block; a hull is asked only where its planes are nearer than what is found."""
    least = np.array([-depth_below(hull, points) for hull in hulls]).clip(min=0.0)
    found: FloatArray = least.min(axis=0)
    out = np.flatnonzero(found > 0.0)
    found[out] = corners.query(points[out])[0]
    for hull, bound in zip(hulls, least, strict=True):
        near = out[bound[out] < found[out]]
        found[near] = np.minimum(found[near], _from_one(hull, points[near]))
    return found


def _from_one(hull: Hull, points: FloatArray) -> FloatArray:
    """Distances of points outside a hull [m], shape [n].

    No plane is further off than the hull. So where the foot on the farthest is a point of the hull
    it is the nearest one; else that lies on an edge.
    """
    planes = hull.planes
    heights = points @ planes[:, :3].T - planes[:, 3]
    farthest = heights.argmax(axis=1)
    found: FloatArray = heights.max(axis=1, initial=0.0)
    feet = points - found[:, None] * planes[farthest, :3]
    missed = depth_below(hull, feet) < -ROUNDING_M
    found[missed] = _from_edges(hull, points[missed])
    return found


def _from_edges(hull: Hull, points: FloatArray) -> FloatArray:
    """Distances of points from the nearest edge [m], shape [n]."""
    pairs = hull.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    start, end = np.moveaxis(hull.vertices[pairs[pairs[:, 0] < pairs[:, 1]]], 1, 0)
    along = end - start
    length2 = (along**2).sum(axis=1)
    passed = points @ along.T - (start * along).sum(axis=1)
    share = (passed / length2).clip(0.0, 1.0)
    # Without the points' own squares, which are the same for all edges.
    squares = (
        (start**2).sum(axis=1) - 2.0 * points @ start.T + share * (share * length2 - 2.0 * passed)
    )
    nearest = squares.argmin(axis=1)
    feet = start[nearest] + share[np.arange(len(points)), nearest, None] * along[nearest]
    return np.asarray(np.linalg.norm(points - feet, axis=1))
