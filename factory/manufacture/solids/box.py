"""Boxes along the axes of a frame."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from trimesh.bounds import corners

from ...asset import Hull
from ...mesh import BoolArray, FloatArray, read_only
from ..decompose.convex import hull_of


@dataclass(frozen=True)
class Box:
    """Lower and upper corner [m], shape [3] each; may reach to infinity."""

    low: FloatArray
    high: FloatArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "low", read_only(self.low))
        object.__setattr__(self, "high", read_only(self.high))

    @classmethod
    def around(cls, points: FloatArray) -> Box:
        """Return the least one that holds some points [m], shape [n, 3]."""
        return cls(points.min(axis=0), points.max(axis=0))

    @property
    def size(self) -> FloatArray:
        """Return the side lengths [m], shape [3]."""
        return np.asarray(self.high - self.low)

    @property
    def empty(self) -> bool:
        """Return whether nothing lies in it."""
        return bool((self.size <= 0.0).any())

    def holds(self, points: npt.ArrayLike, margin: float = 0.0) -> BoolArray:
        """Return which points [m], shape [..., 3], lie in it or within ``margin`` [m] of it."""
        low = self.low - margin
        high = self.high + margin
        x, y, z = np.moveaxis(np.asarray(points), -1, 0)
        within = (x >= low[0]) & (x <= high[0]) & (y >= low[1]) & (y <= high[1])
        return np.asarray(within & (z >= low[2]) & (z <= high[2]))

    def grown(self, margin: npt.ArrayLike) -> Box:
        """Return the box with every side moved out by ``margin`` [m], one or shape [3]."""
        return Box(self.low - np.asarray(margin), self.high + np.asarray(margin))

    def between(self, start: float, end: float, axis: int = 2) -> Box:
        """Return the box from one plane to another across an axis [m], wherever it ended there."""
        low = self.low.copy()
        high = self.high.copy()
        low[axis] = start
        high[axis] = end
        return Box(low, high)

    def shared(self, other: Box) -> Box:
        """Return the room in both boxes."""
        return Box(np.maximum(self.low, other.low), np.minimum(self.high, other.high))

    def turned(self, rows: FloatArray) -> Box:
        """Return the same box in a frame whose axes are ``rows``, quarter turns of this one's."""
        which = np.abs(rows).argmax(axis=1)
        sign = np.sign(rows[np.arange(3), which])
        ends = np.stack([self.low[which] * sign, self.high[which] * sign])
        return Box(ends.min(axis=0), ends.max(axis=0))

    def hull(self) -> Hull | None:
        """Return the box as a convex piece; ``None`` if it is thinner than what engines take."""
        return None if self.empty else hull_of(corners([self.low, self.high]))
