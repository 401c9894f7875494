"""Boxes, cylinders, spheres and their kin as triangle meshes, in their own frame."""

from __future__ import annotations

import numpy as np

from ..description import FloatArray, IntArray

#: Sides of a round cross-section: a 50 mm radius then sags by 0.06 mm.
SEGMENTS = 64
RINGS = 16


def box(size: FloatArray) -> tuple[FloatArray, IntArray]:
    """A box centred at the origin; ``size`` are full edge lengths [m], shape [3]."""
    corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    faces = [triangle for a, b, c, d in quads for triangle in ((a, b, c), (a, c, d))]
    return corners * size, np.array(faces, dtype=np.int64)


def cylinder(radius: float, length: float) -> tuple[FloatArray, IntArray]:
    """A cylinder along z, centred at the origin [m]."""
    return _lathe([(0.0, -length / 2), (radius, -length / 2), (radius, length / 2), (0.0, length / 2)])


def capsule(radius: float, length: float) -> tuple[FloatArray, IntArray]:
    """A cylinder of ``length`` along z with half spheres at its ends [m]."""
    angles = np.linspace(0.0, np.pi / 2, RINGS // 2 + 1)
    lower = [(radius * np.sin(a), -length / 2 - radius * np.cos(a)) for a in angles]
    upper = [(r, -z) for r, z in reversed(lower)]
    return _lathe(lower + upper)


def ellipsoid(radii: FloatArray) -> tuple[FloatArray, IntArray]:
    """An ellipsoid with half axes ``radii`` [m], shape [3]; a sphere where they are equal."""
    angles = np.linspace(0.0, np.pi, RINGS + 1)
    vertices, faces = _lathe([(np.sin(a), -np.cos(a)) for a in angles])
    return vertices * radii, faces


def _lathe(profile: list[tuple[float, float]]) -> tuple[FloatArray, IntArray]:
    """Turn (radius, height) pairs, from pole to pole, around z; the first and last radius are 0."""
    turn = 2.0 * np.pi * np.arange(SEGMENTS) / SEGMENTS
    rings = [np.column_stack([r * np.cos(turn), r * np.sin(turn), np.full(SEGMENTS, z)]) for r, z in profile[1:-1]]
    poles = np.array([[0.0, 0.0, profile[0][1]], [0.0, 0.0, profile[-1][1]]])
    vertices = np.vstack([poles, *rings])
    here = np.arange(SEGMENTS)
    following = (here + 1) % SEGMENTS
    faces = [np.column_stack([np.zeros(SEGMENTS, int), 2 + following, 2 + here])]
    for ring in range(len(rings) - 1):
        a, b = 2 + ring * SEGMENTS, 2 + (ring + 1) * SEGMENTS
        faces.append(np.column_stack([a + here, a + following, b + following]))
        faces.append(np.column_stack([a + here, b + following, b + here]))
    last = 2 + (len(rings) - 1) * SEGMENTS
    faces.append(np.column_stack([np.ones(SEGMENTS, int), last + here, last + following]))
    return vertices, np.vstack(faces).astype(np.int64)
