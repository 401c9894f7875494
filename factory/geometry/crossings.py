"""Where parallel rays cross a surface: one ray per pixel of an orthographic picture."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
import numpy.typing as npt

from ..mesh import FloatArray, IntArray, Mesh
from .triangles import ends_of

BoolArray = npt.NDArray[np.bool_]

#: Pairs of a triangle and a pixel looked at in one go: few enough to stay in a core's cache.
_PAIRS = 50_000
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
    def around(cls, mesh: Mesh, side: Side, pixels: int, margin: int = 1) -> Raster:
        """Return a picture of the whole mesh.

        Args:
            mesh: to be looked at.
            side: from where.
            pixels: along the longest of the mesh's three extents, so that all six sides agree.
            margin: empty pixels around it.
        """
        corners = mesh.bounds @ side.frame.T
        low = corners.min(axis=0)
        size = corners.max(axis=0) - low
        pixel = float(mesh.extents.max()) / pixels
        columns, rows = (int(np.ceil(length / pixel)) + 2 * margin for length in size[:2])
        start = low[:2] + (0.5 - margin + _SHIFT) * pixel
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


@dataclass(frozen=True)
class Crossings:
    """Every place where a ray of a raster crosses a triangle, by pixel, then from near to far.

    Attributes:
        raster: the rays.
        pixel: row * columns + column, shape [n], ascending.
        depth: from the raster's near plane [m], shape [n].
        face: which triangle, shape [n].
        inward: the ray enters there: the triangle faces the viewer, shape [n].
        weights: of the triangle's corners at that place, shape [n, 3]; they add up to 1.
    """

    raster: Raster
    pixel: IntArray
    depth: FloatArray
    face: IntArray
    inward: BoolArray
    weights: FloatArray

    @property
    def first(self) -> IntArray:
        """Return the indices of the nearest crossing of each pixel that has any."""
        return np.flatnonzero(np.diff(self.pixel, prepend=-1))


def crossings(mesh: Mesh, raster: Raster) -> Crossings:
    """Cross a mesh with a raster's rays; time and memory grow with the pixels that are covered."""
    local = mesh.vertices @ raster.side.frame.T
    corners = local[mesh.faces]
    flat = (corners[:, :, :2] - raster.low) / raster.pixel
    depths = corners[:, :, 2] - raster.near
    turns = _doubled_areas(flat)
    found = [_crossed(flat, depths, turns, pairs, raster) for pairs in _batches(flat, raster)]
    if not found:
        found = [(np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros((0, 3)), np.zeros(0))]
    face, pixel, weights, depth = (np.concatenate(parts) for parts in zip(*found, strict=True))
    order = _nearest_first(pixel, depth)
    face = face[order]
    return Crossings(raster, pixel[order], depth[order], face, turns[face] > 0.0, weights[order])


def _batches(flat: FloatArray, raster: Raster) -> Iterator[tuple[IntArray, IntArray, IntArray]]:
    """Yield triangles with the first pixel and the size of the boxes around them, in batches."""
    limit = np.array([raster.columns, raster.rows])
    least, most = ends_of(flat)
    low = np.clip(np.ceil(least), 0, limit).astype(np.int64)
    high = np.clip(np.floor(most) + 1, 0, limit).astype(np.int64)
    size = np.maximum(high - low, 0)
    count = size.prod(axis=1)
    faces = np.flatnonzero(count)
    total = np.cumsum(count[faces])
    start = 0
    while start < len(faces):
        spent = total[start - 1] if start else 0
        stop = max(int(np.searchsorted(total, spent + _PAIRS, "right")), start + 1)
        chosen = faces[start:stop]
        yield chosen, low[chosen], size[chosen]
        start = stop


def _crossed(
    flat: FloatArray,
    depths: FloatArray,
    turns: FloatArray,
    batch: tuple[IntArray, IntArray, IntArray],
    raster: Raster,
) -> tuple[IntArray, IntArray, FloatArray, FloatArray]:
    """Return face, pixel, weights and depth of each crossing of a batch."""
    faces, low, size = batch
    count = size.prod(axis=1)
    owner = np.repeat(np.arange(len(faces)), count)
    place = np.arange(len(owner)) - np.repeat(np.cumsum(count) - count, count)
    down, right = np.divmod(place, size[owner, 0])
    column = low[owner, 0] + right
    row = low[owner, 1] + down
    x, y = np.ascontiguousarray(flat[faces].transpose(2, 1, 0))
    area = turns[faces]
    shares: list[FloatArray] = []
    for k in range(3):
        one = k - 2
        other = k - 1
        with np.errstate(divide="ignore", invalid="ignore"):
            # Of each corner, twice the area that the pixel spans with the other two.
            share = (
                (x[one][owner] - column) * (y[other][owner] - row)
                - (y[one][owner] - row) * (x[other][owner] - column)
            ) / area[owner]
        # Half of a box is outside each edge: what one edge excludes is not asked of the next.
        inside = np.flatnonzero(share >= 0.0)
        owner = owner[inside]
        column = column[inside]
        row = row[inside]
        shares = [*(each[inside] for each in shares), share[inside]]
    weights = np.stack(shares, axis=1)
    face = faces[owner]
    depth = np.einsum("ij,ij->i", weights, depths[face])
    return face, row * raster.columns + column, weights, depth


def _nearest_first(pixel: IntArray, depth: FloatArray) -> IntArray:
    """Return the order by pixel, then depth, then place: ``np.lexsort`` in a quarter of its time.

    Numbers of 64 bits hold all three as long as pixels, depths and places are few enough.
    """
    by_depth = np.argsort(depth)
    rank = np.empty(len(depth), dtype=np.int64)
    rank[by_depth] = np.cumsum(np.diff(depth[by_depth], prepend=-np.inf) > 0.0)
    bits = len(depth).bit_length()
    if int(pixel.max(initial=0)).bit_length() + 2 * bits > 63:
        return np.lexsort((depth, pixel))
    key = (pixel << bits | rank) << bits | np.arange(len(depth))
    key.sort()
    return np.asarray(key & ((1 << bits) - 1))


def _doubled_areas(triangles: FloatArray) -> FloatArray:
    """Return twice the signed areas of flat triangles, shape [n, 3, 2]."""
    right = triangles[:, 1] - triangles[:, 0]
    left = triangles[:, 2] - triangles[:, 0]
    return np.asarray(right[:, 0] * left[:, 1] - right[:, 1] * left[:, 0])
