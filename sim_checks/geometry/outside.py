"""How far points lie outside convex hulls, exactly."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.spatial import cKDTree

from ..description import FloatArray
from .hull import BLOCK, CollisionHull

#: A foot this far beyond a face, as a share of the size of the numbers, is on it but for rounding.
ROUNDING = 1e-12


def distance_outside(points: FloatArray, hulls: Sequence[CollisionHull]) -> FloatArray:
    """Return how far points lie outside all of some hulls [m], shape [point_count]; 0 within one.

    A hull lies at least as far off as the farthest of its face planes, and no hull is farther off
    than the nearest corner; only hulls between the two are measured.

    Args:
        points: [m], shape [point_count, 3].
        hulls: at least one, in the same frame.
    """
    least = np.array([np.maximum(0.0, _beyond(points, hull).max(axis=1)) for hull in hulls])
    corners = np.concatenate([hull.vertices for hull in hulls])
    distance = np.where(least.min(axis=0) > 0.0, cKDTree(corners).query(points)[0], 0.0)
    for number, hull in enumerate(hulls):
        asked = least[number] < distance
        distance[asked] = np.minimum(distance[asked], _distances(points[asked], hull))
    return distance


def _distances(points: FloatArray, hull: CollisionHull) -> FloatArray:
    """Return the distances of points outside a hull [m], shape [point_count].

    The nearest point of a hull lies within a face or on an edge. Within a face it is the foot on
    the farthest face plane, as no plane is farther off than the hull.
    """
    rows = max(1, BLOCK // len(hull.edges))
    blocks = [points[start : start + rows] for start in range(0, len(points), rows)]
    return np.concatenate([np.zeros(0), *(_block_distances(block, hull) for block in blocks)])


def _block_distances(points: FloatArray, hull: CollisionHull) -> FloatArray:
    beyond = _beyond(points, hull)
    farthest = beyond.argmax(axis=1)
    distances: FloatArray = beyond.max(axis=1)
    feet = points - distances[:, None] * hull.normals[farthest]
    slack = ROUNDING * max(1e-3, float(np.abs(points).max(initial=0.0)))
    on_edge = _beyond(feet, hull).max(axis=1) > slack
    distances[on_edge] = _edge_distances(points[on_edge], hull)
    return distances


def _beyond(points: FloatArray, hull: CollisionHull) -> FloatArray:
    """Return how far points lie beyond each face plane [m], shape [point_count, face_count]."""
    return points @ hull.normals.T - hull.offsets


def _edge_distances(points: FloatArray, hull: CollisionHull) -> FloatArray:
    """Return the distances of points to the nearest edge of a hull [m], shape [point_count]."""
    middle = hull.vertices.mean(axis=0)
    starts, ends = (hull.vertices[hull.edges[:, side]] - middle for side in (0, 1))
    along = ends - starts
    squares = np.einsum("ij,ij->i", along, along)
    points = points - middle
    # |p - a|2 without |p|2, which is the same for all edges.
    offset = np.einsum("ij,ij->i", starts, starts) - 2.0 * points @ starts.T
    reach = points @ along.T - np.einsum("ij,ij->i", starts, along)
    share = np.clip(reach / squares, 0.0, 1.0)
    edge = (offset + share * (share * squares - 2.0 * reach)).argmin(axis=1)
    # Small distances drown in the rounding of large squares, so the nearest is measured again.
    share = share[np.arange(len(points)), edge]
    feet = starts[edge] + share[:, None] * along[edge]
    distances: FloatArray = np.linalg.norm(points - feet, axis=1)
    return distances
