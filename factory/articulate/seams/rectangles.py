"""Rectangles whose four sides are covered by evidence for seams."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from ...mesh import FloatArray, IntArray
from ...views.raster import Raster
from .evidence import Seams

#: Lines looked at in each direction; more only find noise.
MOST_LINES = 26
#: Two lines are one if they are nearer than this [pixels].
APART = 4
#: Of the picture's size: the shortest piece of a line, and the shortest side of a rectangle.
SHORTEST = 0.07
#: A line counts, and so does the side of a rectangle on it, where this share of it is covered.
COVERED = 0.55
#: At the rounded corners of a rectangle nothing is asked: share of its side.
CORNER = 0.06
#: All four sides together are covered to at least this.
LEAST_MEAN = 0.72


@dataclass(frozen=True, eq=False)
class Lines:
    """Lines in one direction that may be sides of panels.

    Attributes:
        at: their places across [pixels], ascending, shape [n].
        sums: evidence along each line, summed from its start, shape [n, length + 1].
        relief: likewise, of the shape alone.
        known: likewise, how much of it is not hidden by a handle.
    """

    at: IntArray
    sums: FloatArray
    relief: FloatArray
    known: FloatArray

    def covered(
        self, line: IntArray, start: IntArray, stop: IntArray, *, shape: bool = False
    ) -> FloatArray:
        """Return the share of a line's piece with evidence, or the shape's; arrays broadcast."""
        sums = self.relief if shape else self.sums
        inset = np.asarray((stop - start) * CORNER, dtype=np.int64)
        first = start + inset
        last = stop - inset
        total = sums[line, last] - sums[line, first]
        known = self.known[line, last] - self.known[line, first]
        # Where a handle hides most of a line, nothing can be said for it.
        least = 0.4 * np.maximum(last - first, 1)
        return np.asarray(total / np.maximum(known, least))


def lines_of(seams: Seams, first: int, last: int) -> Lines:
    """Return level lines that may be sides of panels; for upright ones, turn the evidence.

    Args:
        seams: in that direction.
        first: the lowest row that can be a line.
        last: the highest.
    """
    everything = seams.all
    known = seams.known.copy()
    wide = ndimage.maximum_filter1d(everything, 3, axis=0) * known
    shape = ndimage.maximum_filter1d(seams.relief, 3, axis=0) * known
    length = max(int(SHORTEST * everything.shape[1]), 8)
    run = ndimage.uniform_filter1d(wide, length, axis=1)
    strength = np.where(run >= COVERED, wide, 0.0).sum(axis=1)
    # The middle of a groove, not one of its two edges.
    strength = strength + 0.5 * (seams.groove * seams.known).sum(axis=1)
    strength[:first] = 0.0
    strength[last + 1 :] = 0.0
    at = _peaks(strength, length)
    # The object ends at its outline, whatever handle hides that.
    for row in (first, last):
        hidden = known[row] == 0.0
        for each in (wide, shape, known):
            each[row, hidden] = 1.0
    at = np.unique(np.concatenate([at, [first, last]]))
    return Lines(at, _sums(wide[at]), _sums(shape[at]), _sums(known[at]))


def _peaks(strength: FloatArray, least: float) -> IntArray:
    found: list[int] = []
    for row in np.argsort(-strength, kind="stable"):
        if strength[row] < least or len(found) >= MOST_LINES:
            break
        if all(abs(int(row) - other) >= APART for other in found):
            found.append(int(row))
    return np.array(sorted(found), dtype=np.int64)


def _sums(values: FloatArray) -> FloatArray:
    return np.pad(np.cumsum(values, axis=1), ((0, 0), (1, 0)))


@dataclass(frozen=True, eq=False)
class Rectangle:
    """Four lines that close, in pixels of one side.

    Attributes:
        low, high: row and column of its corners, shape [2] each.
        relief: how far each side is covered by the shape alone: bottom, top, left, right, shape
            [4].
    """

    low: IntArray
    high: IntArray
    relief: FloatArray

    @property
    def size(self) -> IntArray:
        """Return the rows and columns."""
        return np.asarray(self.high - self.low)

    @property
    def area(self) -> float:
        """Return the area [pixels]."""
        return float(self.size[0] * self.size[1])

    @property
    def window(self) -> tuple[slice, slice]:
        """Return the rows and columns in it."""
        rows, columns = zip(self.low, self.high + 1, strict=True)
        return slice(*rows), slice(*columns)

    def corners(self, raster: Raster) -> FloatArray:
        """Return its place in a picture: right and up [m], low and high, shape [2, 2]."""
        return raster.low + np.stack([self.low, self.high])[:, ::-1] * raster.pixel

    def holds(self, point: FloatArray) -> bool:
        """Return whether a place (row, column) lies inside."""
        return bool((point >= self.low).all() and (point <= self.high).all())

    def shared(self, other: Rectangle) -> float:
        """Return the area of both [pixels]."""
        side = np.minimum(self.high, other.high) - np.maximum(self.low, other.low)
        return float(np.prod(np.maximum(side, 0)))


def rectangles_of(level: Lines, upright: Lines, shortest: float) -> tuple[Rectangle, ...]:
    """Return every rectangle of these lines that is closed well enough, the best first.

    Args:
        level: horizontal lines.
        upright: vertical lines.
        shortest: least length of a side [pixels].
    """
    rows = _pairs(level.at, shortest)
    columns = _pairs(upright.at, shortest)
    if not len(rows) or not len(columns):
        return ()
    sides = _sides(level, upright, rows, columns, shape=False)
    good = (sides.min(axis=0) >= COVERED) & (sides.mean(axis=0) >= LEAST_MEAN)
    shape = _sides(level, upright, rows, columns, shape=True)
    closed = 0.5 * sides.mean(axis=0) + 0.5 * sides.min(axis=0)
    found = np.argwhere(good)
    best_first = found[np.argsort(-closed[good], kind="stable")]
    return tuple(
        Rectangle(
            np.array([level.at[rows[i, 0]], upright.at[columns[j, 0]]]),
            np.array([level.at[rows[i, 1]], upright.at[columns[j, 1]]]),
            shape[:, i, j],
        )
        for i, j in best_first
    )


def _pairs(at: IntArray, shortest: float) -> IntArray:
    low, high = np.triu_indices(len(at), 1)
    far = at[high] - at[low] >= shortest
    return np.stack([low[far], high[far]], axis=1)


def _sides(
    level: Lines, upright: Lines, rows: IntArray, columns: IntArray, *, shape: bool
) -> FloatArray:
    """Cover of bottom, top, left and right, shape [4, row_pairs, column_pairs]."""
    lying = rows.T[:, :, None]
    standing = columns.T[:, None, :]
    across = level.covered(lying, *upright.at[standing], shape=shape)
    along = upright.covered(standing, *level.at[lying], shape=shape)
    return np.concatenate([across, along])
