"""A panel: a flat piece in the front plane, and pieces mounted on it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...mesh import FloatArray, IntArray
from ...part import OpensBy, Panel
from .scene import FRONT, RECT, SIDEWAYS, UP

#: Against rounding [m].
HAIR = 1e-9


@dataclass(frozen=True)
class FrontSlab:
    """A slab in the front and pieces mounted on it, view frame [m].

    Attributes:
        slabs: pieces that form the slab itself.
        low, high: box of the slabs, shape [3].
        mounted: further pieces that move along: handle, trim, glass.
        handle: box of the handle, shape [2, 3]; ``None`` if nothing protrudes.
        is_box: the one slab is a whole drawer in one piece; ``high`` is then that of its front
            only.
    """

    slabs: tuple[int, ...]
    low: FloatArray
    high: FloatArray
    mounted: tuple[int, ...] = ()
    handle: FloatArray | None = None
    is_box: bool = False

    @property
    def width(self) -> float:
        """Return the horizontal side [m]."""
        return float(self.high[SIDEWAYS] - self.low[SIDEWAYS])

    @property
    def height(self) -> float:
        """Return the vertical side [m]."""
        return float(self.high[UP] - self.low[UP])

    @property
    def depth(self) -> float:
        """Return the thickness [m]."""
        return float(self.high[FRONT] - self.low[FRONT])

    @property
    def area(self) -> float:
        """Return the area of the front rectangle [m2]."""
        return self.width * self.height

    @property
    def center(self) -> FloatArray:
        """Return the middle of the slab's box [m], shape [3]."""
        return np.asarray((self.low + self.high) / 2.0)

    def point(self, across: float, depth: float, up: float) -> FloatArray:
        """Return a point [m] at shares of the front's sides, at a depth [m], shape [3]."""
        x = self.low[SIDEWAYS] + across * self.width
        return np.array([x, depth, self.low[UP] + up * self.height])

    @property
    def has_side_handle(self) -> bool:
        """Tell whether an upright handle is near the left or right edge: it turns."""
        if self.handle is None:
            return False
        width, _, height = self.handle[1] - self.handle[0]
        offset = abs(float(self.handle[:, SIDEWAYS].mean() - self.center[SIDEWAYS]))
        return bool(offset >= 0.3 * self.width and height >= 1.5 * width)

    @property
    def pieces(self) -> IntArray:
        """Return the slabs and the pieces mounted on them, sorted."""
        return np.array(sorted({*self.slabs, *self.mounted}), dtype=np.int64)

    def outline(self, opens: OpensBy) -> Panel:
        """Return it as a panel, in the view frame, that opens so."""
        # To the right, up and away from the viewer.
        frame = np.eye(3)[[SIDEWAYS, UP, FRONT]]
        return Panel(frame, self.low[RECT], self.high[RECT], self.low[FRONT], self.depth, opens)


def overlap_area(
    low: FloatArray, high: FloatArray, other_low: FloatArray, other_high: FloatArray
) -> FloatArray:
    """Return the area that boxes share with another, seen from the front [m2]; a line has some.

    Args:
        low: their lower corners [m], shape [..., 3].
        high: their upper corners [m], shape [..., 3].
        other_low: lower corner of the other [m], shape [3].
        other_high: its upper corner [m].
    """
    sides = np.minimum(high, other_high) - np.maximum(low, other_low) + HAIR
    return np.asarray(np.prod(np.maximum(sides[..., RECT], 0.0), axis=-1))


def rect_area(extents: FloatArray) -> FloatArray:
    """Return the area of rectangles across the front, of extents of shape [n, 3]."""
    return np.asarray((extents[:, SIDEWAYS] + HAIR) * (extents[:, UP] + HAIR))
