"""A part's surroundings, in cells: one look-up tells whether a moved point went through them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...mesh import BoolArray, FloatArray, IntArray
from .surfels import Surfels

#: Along the longest side.
CELLS = 72
#: A surface met at a flatter angle than this sine is slid along, not hit.
GRAZING = 0.35


@dataclass(frozen=True)
class Grid:
    """Cells that hold a surfel of the surroundings each.

    Attributes:
        low: lower corner [m], shape [3].
        cell: side of a cell [m].
        tenant: index of a surfel in each cell, -1 where it is empty, shape [x, y, z].
        surfels: of the surroundings.
    """

    low: FloatArray
    cell: float
    tenant: IntArray
    surfels: Surfels

    def hits(self, points: FloatArray, headings: FloatArray, travelled: FloatArray) -> BoolArray:
        """Tell whether each moved point went through the surroundings, shape of ``travelled``.

        Args:
            points: where they are now [m], shape [..., 3].
            headings: unit direction in which they go, shape [..., 3].
            travelled: how far they have come [m], shape [...]. Cells within one and a half of the
                start do not count: parts touch at rest.
        """
        tenant = self._tenants(points)
        found = (tenant >= 0) & (travelled > 1.5 * self.cell)
        met = self.surfels.at(tenant[found])
        approach = np.einsum("ij,ij->i", headings[found], met.normals)
        beyond = np.einsum("ij,ij->i", points[found] - met.points, met.normals)
        beyond *= np.sign(approach) / self.cell
        found[found] = (np.abs(approach) > GRAZING) & (beyond > -0.4)
        return found

    def filled(self, points: FloatArray) -> BoolArray:
        """Return whether the cells of points [m] hold anything, shape [...]."""
        return np.asarray(self._tenants(points) >= 0)

    def _tenants(self, points: FloatArray) -> IntArray:
        """Return the surfel in the cell of each point [m]; -1 if none or outside, shape [...]."""
        cells = np.floor((points - self.low) / self.cell).astype(np.int64)
        inside = np.asarray(((cells >= 0) & (cells < self.tenant.shape)).all(axis=-1))
        i, j, k = np.moveaxis(np.where(inside[..., None], cells, 0), -1, 0)
        return np.where(inside, self.tenant[i, j, k], -1)


def grid_around(surfels: Surfels, low: FloatArray, high: FloatArray) -> Grid:
    """Return a grid over the box from ``low`` to ``high`` [m] with the surfels in it."""
    cell = float((high - low).max()) / CELLS
    shape = np.maximum(np.ceil((high - low) / cell).astype(np.int64), 1)
    inside = ((surfels.points >= low) & (surfels.points < low + shape * cell)).all(axis=1)
    kept = surfels.at(np.flatnonzero(inside))
    i, j, k = np.minimum(((kept.points - low) / cell).astype(np.int64), shape - 1).T
    tenant = np.full(shape, -1, dtype=np.int64)
    tenant[i, j, k] = np.arange(len(kept))
    return Grid(low, cell, tenant, kept)
