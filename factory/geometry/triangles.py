"""How large triangles are, and how far they reach."""

from __future__ import annotations

import numpy as np

from ..mesh import FloatArray, Mesh


def face_areas(mesh: Mesh) -> FloatArray:
    """Return the area of every face [m2], shape [face_count]."""
    a, b, c = (mesh.vertices[mesh.faces[:, corner]] for corner in range(3))
    return np.asarray(np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2.0)


def ends_of(corners: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the least and the greatest of what the three corners of every triangle have.

    Args:
        corners: shape [triangle_count, 3, ...]: positions, or heights above a plane.

    Returns:
        Two of shape [triangle_count, ...]; as ``min`` and ``max`` along the second axis give them,
        which take five times as long along so short an axis.
    """
    first, second, third = np.moveaxis(corners, 1, 0)
    low = np.minimum(np.minimum(first, second), third)
    high = np.maximum(np.maximum(first, second), third)
    return low, high
