"""A box that somebody drew on a side, moved to the seams that it means."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...intake.stated import Box
from ...mesh import FloatArray, IntArray, Mesh
from ...views.raster import Side
from ..seams.fronts import Front
from ..seams.rectangles import Lines, Rectangle

#: A stated edge may be off by this share of the side's picture, and by so many pixels at least.
OFF = 0.05
LEAST_OFF = 4.0
#: A seam is meant if it is covered to this share along the edge; one at the end of the reach
#: counts half.
COVERED = 0.35
#: A stated edge this near to the outline is the outline.
AT_OUTLINE = 0.02


@dataclass(frozen=True)
class StatedFrame:
    """What a side's shares are of, in that side's frame: right and up [m].

    Attributes:
        low: left and lower end, shape [2].
        size: width and height, shape [2].
    """

    low: FloatArray
    size: FloatArray

    @classmethod
    def of(cls, mesh: Mesh, side: Side) -> StatedFrame:
        """Return the picture of a whole mesh."""
        ends = mesh.bounds @ side.frame.T
        return cls(ends.min(axis=0)[:2], np.abs(ends[1] - ends[0])[:2])

    def place(self, box: Box) -> FloatArray:
        """Return a box's corners [m], low and high, shape [2, 2]."""
        return np.asarray(self.low + np.array(box).reshape(2, 2) * self.size)


def snap(front: Front, frame: StatedFrame, box: Box) -> Rectangle:
    """Return the rectangle of seams that a stated box means, in pixels of its side.

    An edge near which no seam runs stays where it was stated.

    Args:
        front: the side.
        frame: of the mesh on that side.
        box: left, lower, right, upper edge, in shares of the picture.
    """
    raster = front.relief.raster
    corners = (frame.place(box) - raster.low) / raster.pixel
    stated = np.rint(corners[:, ::-1]).astype(np.int64)
    reach = np.maximum(OFF * frame.size[::-1] / raster.pixel, LEAST_OFF)
    outline = front.relief.box
    stated = np.clip(stated, outline[0], outline[1])
    lines = (front.level, front.upright)
    ends = np.array(box).reshape(2, 2)[:, ::-1]
    placed = stated.copy()
    for axis in (0, 1):
        start, stop = placed[:, 1 - axis]
        for end in (0, 1):
            if abs(ends[end, axis] - end) <= AT_OUTLINE:
                placed[end, axis] = outline[end, axis]
            else:
                placed[end, axis] = _nearest_seam(
                    lines[axis], int(stated[end, axis]), reach[axis], int(start), int(stop)
                )
        if (
            2 * np.ptp(placed[:, axis]) < np.ptp(stated[:, axis])
            or placed[0, axis] > placed[1, axis]
        ):
            # Both edges of something thin found the same seam.
            placed[:, axis] = stated[:, axis]
    relief = [
        _in_relief(lines[axis], int(placed[end, axis]), placed[:, 1 - axis])
        for axis in (0, 1)
        for end in (0, 1)
    ]
    return Rectangle(placed[0], placed[1], np.array(relief))


def _nearest_seam(lines: Lines, stated: int, reach: float, start: int, stop: int) -> int:
    """Return the line within reach that covers an edge best, the nearer counting more.

    The edge stays where it was stated if there is none.
    """
    away = np.abs(lines.at - stated)
    near = np.flatnonzero(away <= reach)
    if not len(near) or stop <= start:
        return stated
    cover = lines.covered(near, np.int64(start), np.int64(stop))  # type: ignore[arg-type]
    value = np.where(cover >= COVERED, cover * (1.0 - 0.5 * away[near] / reach), 0.0)
    return int(lines.at[near[value.argmax()]]) if value.any() else stated


def _in_relief(lines: Lines, at: int, along: IntArray) -> float:
    """Return how far the shape covers the line at a place between two ends; 0 without a line."""
    index = np.flatnonzero(lines.at == at)
    if not len(index) or along[1] <= along[0]:
        return 0.0
    return float(lines.covered(index, along[0], along[1], shape=True)[0])
