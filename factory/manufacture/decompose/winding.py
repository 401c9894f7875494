"""Which points a closed solid holds."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from manifold3d import Manifold

from ...mesh import FloatArray
from .solids import triangles_of

#: Points that are held against a solid at once.
TOGETHER = 64


def inside(solid: Manifold, points: FloatArray) -> npt.NDArray[np.bool_]:
    """Return which points [m], shape [n, 3], lie in a solid, by its winding number, shape [n].

    The solid angles are those of van Oosterom and Strackee 1983.
    """
    vertices, faces = triangles_of(solid)
    found = np.zeros(len(points), dtype=bool)
    for start in range(0, len(points), TOGETHER):
        arms = vertices[faces][None] - points[start : start + TOGETHER, None, None]
        lengths = np.linalg.norm(arms, axis=3)
        a, b, c = np.moveaxis(arms, 2, 0)
        la, lb, lc = np.moveaxis(lengths, 2, 0)
        over = np.einsum("ijk,ijk->ij", a, np.cross(b, c))
        under = (
            la * lb * lc
            + np.einsum("ijk,ijk->ij", a, b) * lc
            + np.einsum("ijk,ijk->ij", b, c) * la
            + np.einsum("ijk,ijk->ij", c, a) * lb
        )
        angles = 2.0 * np.arctan2(over, under).sum(axis=1)
        found[start : start + TOGETHER] = np.abs(angles) > 2.0 * np.pi
    return found
