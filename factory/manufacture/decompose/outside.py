"""How far points lie outside convex hulls, exactly."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...asset import Hull
from ...mesh import FloatArray
from .convex import depth_below, edges_of

#: Points measured at a time: what is known of them stays small, and near the processor.
BLOCK = 512
#: What lies no further beyond all planes is within but for rounding [m].
ROUNDING_M = 1e-12


def outside(hulls: Sequence[Hull], points: FloatArray) -> FloatArray:
    """Return how far each point [m], shape [n, 3], lies outside all hulls [m], shape [n].

    Zero within one, infinite where there are none.
    """
    if not hulls:
        return np.full(len(points), np.inf)
    blocks = [points[start : start + BLOCK] for start in range(0, len(points), BLOCK)]
    return np.concatenate([np.zeros(0), *(_outside(hulls, block) for block in blocks)])


def uncovered(hulls: Sequence[Hull], points: FloatArray) -> float:
    """Return how far the worst of ``points`` lies outside all hulls [m]; zero if none does."""
    return float(outside(hulls, points).max(initial=0.0))


def _outside(hulls: Sequence[Hull], points: FloatArray) -> FloatArray:
    """Return the same of a block of points: first from the hull whose planes are nearest.

    Others are asked only where their planes are nearer than that.
    """
    least = np.array([-depth_below(hull, points) for hull in hulls])
    found: FloatArray = np.where(least.min(axis=0) > ROUNDING_M, np.inf, 0.0)
    likeliest = least.argmin(axis=0)
    for first in (True, False):
        for number, hull in enumerate(hulls):
            asked = np.flatnonzero((least[number] < found) & ((likeliest == number) == first))
            if len(asked):
                found[asked] = np.minimum(found[asked], _from_one(hull, points[asked]))
    return found


def _from_one(hull: Hull, points: FloatArray) -> FloatArray:
    """Return the distances of points outside a hull [m], shape [n].

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
    """Return the distances of points from the nearest edge [m], shape [n]."""
    start, end = np.moveaxis(hull.vertices[edges_of(hull)], 1, 0)
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
