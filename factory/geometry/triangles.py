"""How large triangles are, which way they face, how far they reach, and points within them."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ..mesh import FloatArray, Mesh, cross

#: The corner after each of a triangle's three.
FOLLOWING = [1, 2, 0]


def doubled_normals(corners: FloatArray) -> FloatArray:
    """Return each triangle's normal times twice its area [m2], shape [n, 3].

    Args:
        corners: positions [m], shape [n, 3, 3].
    """
    first = corners[:, 0]
    return cross(corners[:, 1] - first, corners[:, 2] - first)


def areas_of(corners: FloatArray) -> FloatArray:
    """Return the area of each triangle [m2], shape [n]; ``corners`` [m] have shape [n, 3, 3]."""
    return np.asarray(np.linalg.norm(doubled_normals(corners), axis=1) / 2.0)


def face_areas(mesh: Mesh) -> FloatArray:
    """Return the area of every face [m2], shape [face_count]."""
    return areas_of(mesh.vertices[mesh.faces])


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


def meet_box(corners: FloatArray, low: FloatArray, high: FloatArray) -> npt.NDArray[np.bool_]:
    """Tell which triangles meet an axis-aligned box, by separating axes (Akenine-Moller 2001).

    Args:
        corners: [m], shape [n, 3, 3].
        low: the box's lower corner [m], shape [3].
        high: its upper corner [m].

    Returns:
        Shape [n].
    """
    half = (high - low) / 2.0
    local = corners - (low + high) / 2.0
    edges = local[:, FOLLOWING] - local
    least, most = ends_of(local)
    normals = cross(edges[:, 0], edges[:, 1])
    offsets = np.abs(np.einsum("nk,nk->n", normals, local[:, 0]))
    across = np.cross(np.eye(3), edges[:, :, None]).reshape(-1, 9, 3)
    heights = np.einsum("nak,nck->nca", across, local)
    reach = np.abs(across) @ half
    lowest, highest = ends_of(heights)
    return np.asarray(
        ((least <= half) & (most >= -half)).all(axis=1)
        & (offsets <= np.abs(normals) @ half)
        & ((lowest <= reach) & (highest >= -reach)).all(axis=1)
    )


def points_within(corners: FloatArray, u: FloatArray, v: FloatArray) -> FloatArray:
    """Return a point within each triangle [m], shape [n, 3]; even if the shares are.

    Args:
        corners: positions [m], shape [n, 3, 3].
        u: shares of its side to the second corner, 0 to 1, shape [n].
        v: likewise, to the third.
    """
    over = u + v > 1.0
    u = np.where(over, 1.0 - u, u)[:, None]
    v = np.where(over, 1.0 - v, v)[:, None]
    first = corners[:, 0]
    return first + u * (corners[:, 1] - first) + v * (corners[:, 2] - first)
