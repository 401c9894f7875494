"""The six straight sides of an object, and the pixels of one side's picture."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from ..mesh import FloatArray, IntArray, Mesh

#: Along the longest extent of an object.
PIXELS = 320
#: Rays miss the round numbers that vertices of modelled meshes lie on [pixels].
_SHIFT = 1.37e-4


class Side(StrEnum):
    """A side of the object that is looked at straight, object frame; the front is -Y."""

    FRONT = "front"
    BACK = "back"
    LEFT = "left"
    RIGHT = "right"
    TOP = "top"
    BOTTOM = "bottom"

    @property
    def frame(self) -> FloatArray:
        """Return rows: right, up, and away from the viewer, unit vectors; shape [3, 3]."""
        return _FRAMES[self]


def side_facing(direction: FloatArray) -> Side:
    """Return the side that looks most nearly in a direction, shape [3]."""
    return min(Side, key=lambda side: float(side.frame[2] @ direction))


_FRAMES = {
    Side.FRONT: np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]]),
    Side.BACK: np.array([[-1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]),
    Side.LEFT: np.array([[0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]),
    Side.RIGHT: np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0]]),
    Side.TOP: np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]]),
    Side.BOTTOM: np.array([[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]]),
}


@dataclass(frozen=True)
class Raster:
    """The pixels of one side's picture, in that side's frame: right, up, away.

    Attributes:
        side: which is looked at.
        low: centre of the pixel of row 0 and column 0: right and up [m], shape [2]; row 0 is the
            lowest.
        near: where depth is 0: the nearest point of the mesh, away from the viewer [m].
        pixel: length of a pixel's side [m].
        rows, columns: how many.
    """

    side: Side
    low: FloatArray
    near: float
    pixel: float
    rows: int
    columns: int

    @classmethod
    def around(cls, mesh: Mesh, side: Side, pixels: int) -> Raster:
        """Return a picture of the whole mesh, within one row of empty pixels.

        Args:
            mesh: to be looked at.
            side: from where.
            pixels: along the longest of the mesh's three extents, so that all six sides agree.
        """
        corners = mesh.bounds @ side.frame.T
        low = corners.min(axis=0)
        size = corners.max(axis=0) - low
        pixel = float(mesh.extents.max()) / pixels
        columns, rows = (int(np.ceil(length / pixel)) + 2 for length in size[:2])
        start = low[:2] + (_SHIFT - 0.5) * pixel
        return cls(side, start, float(low[2]), pixel, max(rows, 1), max(columns, 1))

    @property
    def right(self) -> FloatArray:
        """Return how far to the right the columns' centres lie [m], shape [columns]."""
        return np.asarray(self.low[0] + np.arange(self.columns) * self.pixel)

    @property
    def up(self) -> FloatArray:
        """Return how far up the rows' centres lie [m], shape [rows]."""
        return np.asarray(self.low[1] + np.arange(self.rows) * self.pixel)

    def window(self, low: FloatArray, high: FloatArray) -> tuple[slice, slice]:
        """Return the rows and columns whose centres lie between two corners, right and up [m]."""
        columns = np.searchsorted(self.right, [low[0], high[0]])
        rows = np.searchsorted(self.up, [low[1], high[1]])
        return slice(rows[0], rows[1]), slice(columns[0], columns[1])

    def nearest(self, local: FloatArray) -> tuple[IntArray, IntArray]:
        """Return the rows and columns nearest to points of the side's frame [m], shape [n, 3]."""
        rows = np.rint((local[:, 1] - self.low[1]) / self.pixel).astype(np.int64)
        columns = np.rint((local[:, 0] - self.low[0]) / self.pixel).astype(np.int64)
        return np.clip(rows, 0, self.rows - 1), np.clip(columns, 0, self.columns - 1)

    def points(self, rows: IntArray, columns: IntArray, depth: FloatArray) -> FloatArray:
        """Return points in the object frame [m], shape [..., 3], at depths [m] behind pixels."""
        across = np.stack(
            [
                self.low[0] + np.asarray(columns) * self.pixel,
                self.low[1] + np.asarray(rows) * self.pixel,
                self.near + np.asarray(depth),
            ],
            axis=-1,
        )
        return np.asarray(across @ self.side.frame)

    def pixels(self, points: FloatArray) -> FloatArray:
        """Return row, column (both with fractions) and depth [m] of points; shape [..., 3]."""
        local = np.asarray(points) @ self.side.frame.T
        column = (local[..., 0] - self.low[0]) / self.pixel
        row = (local[..., 1] - self.low[1]) / self.pixel
        return np.stack([row, column, local[..., 2] - self.near], axis=-1)
