"""Boxes, cylinders, spheres and their kin as triangle meshes, in their own frame."""

from __future__ import annotations

from functools import lru_cache
from itertools import combinations

import numpy as np

from ..description import FloatArray, IntArray

#: Sides of a round cross-section, which then sags by less than 0.1 % of its radius.
SEGMENTS = 72
#: Parts of each edge of the icosahedron that a ball is made of, which then sags by less than 0.1 %
#: of its radius; even, so that the ball reaches its radius along every axis.
PARTS = 18


def box(size: FloatArray) -> tuple[FloatArray, IntArray]:
    """Return a box centred at the origin; ``size`` are full edge lengths [m], shape [3]."""
    corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    faces = [triangle for a, b, c, d in quads for triangle in ((a, b, c), (a, c, d))]
    return corners * size, np.array(faces, dtype=np.int64)


def cylinder(radius: float, length: float) -> tuple[FloatArray, IntArray]:
    """Return a cylinder along z, centred at the origin [m]."""
    turn = 2.0 * np.pi * np.arange(SEGMENTS) / SEGMENTS
    ring = radius * np.column_stack([np.cos(turn), np.sin(turn), np.zeros(SEGMENTS)])
    up = np.array([0.0, 0.0, length / 2])
    vertices = np.vstack([-up, up, ring - up, ring + up])
    low = 2 + np.arange(SEGMENTS)
    next_low = np.roll(low, -1)
    high = low + SEGMENTS
    next_high = next_low + SEGMENTS
    pole = np.zeros_like(low)
    corners = (pole, next_low, low), (low, next_low, next_high), (low, next_high, high)
    faces = [np.column_stack(each) for each in (*corners, (pole + 1, high, next_high))]
    return vertices, np.vstack(faces).astype(np.int64)


def capsule(radius: float, length: float) -> tuple[FloatArray, IntArray]:
    """Return a cylinder of ``length`` along z with half spheres at its ends [m]."""
    vertices, faces = _capsule()
    side = np.sign(vertices[:, 2:]) * [0.0, 0.0, 1.0]
    return (vertices - side) * radius + side * length / 2.0, faces


def ellipsoid(radii: FloatArray) -> tuple[FloatArray, IntArray]:
    """Return an ellipsoid with half axes ``radii`` [m], shape [3]; a sphere where all are equal."""
    vertices, faces = _ball()
    return vertices * radii, faces


@lru_cache(maxsize=1)
def _ball() -> tuple[FloatArray, IntArray]:
    """Return a ball of radius 1: an icosahedron, every face cut into equal parts and blown up."""
    golden = (1.0 + np.sqrt(5.0)) / 2.0
    signs = [(a, b) for a in (-1.0, 1.0) for b in (-golden, golden)]
    corners = np.array([np.roll([0.0, a, b], shift) for a, b in signs for shift in range(3)])
    near = np.linalg.norm(corners[:, None] - corners[None], axis=2) < 2.1
    steps = [(i, j, PARTS - i - j) for i in range(PARTS + 1) for j in range(PARTS + 1 - i)]
    threes = combinations(range(12), 3)
    faces = [three for three in threes if all(near[pair] for pair in combinations(three, 2))]
    points = np.vstack([np.array(steps) @ corners[list(face)] for face in faces])
    points /= np.linalg.norm(points, axis=1)[:, None]
    # Neighbouring faces share the points of an edge.
    _, first = np.unique(np.round(points, 9) + 0.0, axis=0, return_index=True)
    return _hull(points[np.sort(first)])


@lru_cache(maxsize=1)
def _capsule() -> tuple[FloatArray, IntArray]:
    """Return a capsule of radius 1 and length 2, not counting its ends."""
    turn = 2.0 * np.pi * np.arange(SEGMENTS) / SEGMENTS
    ring = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(SEGMENTS)])
    ball = _ball()[0]
    # Points of the ball just beside the ring would only make slivers.
    caps = ball[np.abs(ball[:, 2]) > np.pi / SEGMENTS]
    shift = np.array([0.0, 0.0, 1.0])
    ends = [np.vstack([ring, caps[side * caps[:, 2] > 0.0]]) + side * shift for side in (-1.0, 1.0)]
    return _hull(np.vstack(ends))


def _hull(points: FloatArray) -> tuple[FloatArray, IntArray]:
    # Whoever only asks for --help waits for no SciPy.
    from ..geometry.hull import convex_hull

    hull = convex_hull(points)
    return hull.vertices, hull.triangles
