"""Cells to be made of convex pieces, and cells that must stay free of them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy import ndimage

from ...geometry.rows import distinct_rows
from ...mesh import BoolArray, FloatArray
from .lattice import Lattice, Span

#: Filling what must stay free is so much worse than filling what is merely empty: an inside, and
#: where something moves.
INSIDE = 3
PATH = 60
#: What a piece fills wrongly is let be below these shares of all matter, and of the whole lattice.
TRIFLE = 0.004
TRIFLE_OF_ALL = 0.0008

Weights = npt.NDArray[np.uint8]


@dataclass(frozen=True)
class Matter:
    """Cells to be made of convex pieces.

    Attributes:
        lattice: of cells.
        solid: cells that belong to it.
        whole: cells that are within the mesh, its own and others.
        free: how much worse it is to fill a cell than one that is merely empty; 0: no worse.
        points: of its surface [m], shape [n, 3].
    """

    lattice: Lattice
    solid: BoolArray
    whole: BoolArray
    free: Weights
    points: FloatArray

    @cached_property
    def sparse(self) -> FloatArray:
        """Return one point of the surface per eight cells [m], shape [n, 3]."""
        cells = [
            np.searchsorted(line, self.points[:, axis]) // 2
            for axis, line in enumerate(self.lattice.lines)
        ]
        first, _ = distinct_rows(np.column_stack(cells))
        return self.points[first]

    @cached_property
    def trifle(self) -> float:
        """Return what a piece may fill wrongly [m3]."""
        volumes = self.lattice.volumes
        return TRIFLE * float(volumes[self.solid].sum()) + TRIFLE_OF_ALL * float(volumes.sum())

    @cached_property
    def unwanted(self) -> Weights:
        """Return how bad it is to fill a cell: one that must stay free, or air; 0: not."""
        return np.asarray(self.free + (~self.whole & ~self.solid).astype(np.uint8))

    @cached_property
    def deep(self) -> BoolArray:
        """Return cells' corners that lie within the mesh, off its rim; one more each way."""
        return ~any_around(np.pad(~self.whole, 1, constant_values=True))[1:-1, 1:-1, 1:-1]

    def volume(self, span: Span) -> float:
        """Return the volume of the matter in some cells [m3]."""
        return float(self.lattice.volumes[span][self.solid[span]].sum())


def any_around(cells: BoolArray) -> BoolArray:
    """Return for each corner of cells whether any cell around it is set, one more each way."""
    return np.asarray(ndimage.maximum_filter(np.pad(cells, 1), size=2)[1:, 1:, 1:])
