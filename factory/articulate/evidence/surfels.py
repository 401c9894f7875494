"""Evenly spread, oriented points on triangles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...geometry.triangles import doubled_normals, points_within
from ...mesh import BoolArray, FloatArray, IntArray


@dataclass(frozen=True)
class Surfels:
    """Points of a surface with the normals of their faces, object frame.

    Attributes:
        points: positions [m], shape [n, 3].
        normals: unit vectors, shape [n, 3]; which side they look at means nothing (sheets have
            two).
    """

    points: FloatArray
    normals: FloatArray

    def __len__(self) -> int:
        return len(self.points)

    def at(self, rows: IntArray | BoolArray) -> Surfels:
        """Return some of them, in that order."""
        return Surfels(self.points[rows], self.normals[rows])

    def facing(self, direction: FloatArray) -> BoolArray:
        """Tell which look along a unit direction, either way, to 26 degrees, shape [n]."""
        return np.asarray(np.abs(self.normals @ direction) > 0.9)

    def some(self, count: int) -> Surfels:
        """Pick at most ``count`` of them, evenly."""
        if len(self) <= count:
            return self
        return self.at(np.linspace(0, len(self) - 1, count).astype(np.int64))


#: So many tell the surface of a whole object.
WHOLE = 20_000
#: Fractional parts of multiples of these fill the unit square evenly (the plastic number's powers,
#: M. Roberts 2018).
SPREAD = np.array([0.7548776662466927, 0.5698402909980532])


def spread(triangles: FloatArray, count: int) -> Surfels:
    """Spread points about evenly, always the same for the same triangles.

    Args:
        triangles: corners [m], shape [face_count, 3, 3].
        count: of points, at equal steps of accumulated area; none if nothing has any area.
    """
    return spread_owned(triangles, count)[0]


def spread_owned(triangles: FloatArray, count: int) -> tuple[Surfels, IntArray]:
    """Spread points as :func:`spread` does, with the triangle of each, shape [n]."""
    normals = doubled_normals(triangles)
    double_area = np.sqrt(np.einsum("ij,ij->i", normals, normals))
    reached = np.cumsum(double_area)
    if not len(reached) or not reached[-1] > 0.0:
        return Surfels(np.zeros((0, 3)), np.zeros((0, 3))), np.zeros(0, dtype=np.int64)
    owner = np.searchsorted(reached, (np.arange(count) + 0.5) / count * reached[-1])
    owner = np.minimum(owner, len(triangles) - 1)
    u, v = np.mod(0.5 + np.arange(1, count + 1)[:, None] * SPREAD, 1.0).T
    points = points_within(triangles[owner], u, v)
    return Surfels(points, normals[owner] / np.maximum(double_area[owner], 1e-300)[:, None]), owner
