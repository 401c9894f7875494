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
        shape: cells along each axis.
        tenant: index of a surfel, -1 where the cell is empty, shape [product of ``shape``].
        surfels: of the surroundings.
    """

    low: FloatArray
    cell: float
    shape: tuple[int, int, int]
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
        cells = ((points - self.low) / self.cell).astype(np.int64)
        size = np.array(self.shape)
        inside = ((points >= self.low) & (cells < size)).all(axis=-1) & (
            travelled > 1.5 * self.cell
        )
        index = np.flatnonzero(inside)
        i, j, k = cells.reshape(-1, 3)[index].T
        tenant = self.tenant[(i * self.shape[1] + j) * self.shape[2] + k]
        index = index[tenant >= 0]
        tenant = tenant[tenant >= 0]
        normals = self.surfels.normals[tenant]
        approach = np.einsum("ij,ij->i", headings.reshape(-1, 3)[index], normals)
        beyond = np.einsum(
            "ij,ij->i", points.reshape(-1, 3)[index] - self.surfels.points[tenant], normals
        )
        beyond *= np.sign(approach) / self.cell
        found = np.zeros(travelled.size, dtype=bool)
        found[index] = (np.abs(approach) > GRAZING) & (beyond > -0.4)
        return found.reshape(travelled.shape)

    def filled(self, points: FloatArray) -> BoolArray:
        """Return whether the cells of points [m] hold anything, shape [...]."""
        cells = np.floor((points - self.low) / self.cell).astype(np.int64)
        inside = np.asarray(((cells >= 0) & (cells < np.array(self.shape))).all(axis=-1))
        i, j, k = np.where(inside[..., None], cells, 0).reshape(-1, 3).T
        tenant = self.tenant[(i * self.shape[1] + j) * self.shape[2] + k].reshape(inside.shape)
        return np.asarray(inside & (tenant >= 0))


def grid_around(surfels: Surfels, low: FloatArray, high: FloatArray) -> Grid:
    """Return a grid over the box from ``low`` to ``high`` [m] with the surfels in it."""
    cell = float((high - low).max()) / CELLS
    shape = np.maximum(np.ceil((high - low) / cell).astype(np.int64), 1)
    inside = ((surfels.points >= low) & (surfels.points < low + shape * cell)).all(axis=1)
    kept = Surfels(surfels.points[inside], surfels.normals[inside])
    cells = np.minimum(((kept.points - low) / cell).astype(np.int64), shape - 1)
    tenant = np.full(int(np.prod(shape)), -1, dtype=np.int64)
    tenant[(cells[:, 0] * shape[1] + cells[:, 1]) * shape[2] + cells[:, 2]] = np.arange(len(kept))
    return Grid(low, cell, (int(shape[0]), int(shape[1]), int(shape[2])), tenant, kept)
