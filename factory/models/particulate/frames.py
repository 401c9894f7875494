"""The unit boxes the network sees, and the way back."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ...mesh import FloatArray, read_only


@dataclass(frozen=True)
class UnitBox:
    """Moves a box's centre to the origin and makes its longest side 1.

    Attributes:
        center: in the outer frame [outer length units], shape [3].
        size: the longest side [outer length units].
    """

    center: FloatArray
    size: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "center", read_only(self.center))

    @classmethod
    def around(cls, points: npt.ArrayLike) -> UnitBox:
        """Return the box of ``points``, shape [n, 3]; a single point gets the size 1."""
        cloud = np.asarray(points, dtype=np.float64)
        low = cloud.min(axis=0)
        high = cloud.max(axis=0)
        size = float((high - low).max())
        return cls((low + high) / 2.0, size if size > 0.0 else 1.0)

    def inside(self, points: npt.ArrayLike) -> FloatArray:
        """Map the outer to the unit frame, shape [n, 3]."""
        return np.asarray((np.asarray(points, dtype=np.float64) - self.center) / self.size)

    def then(self, inner: UnitBox) -> UnitBox:
        """Return the one box that does what this one and then ``inner`` do."""
        return UnitBox(self.center + self.size * inner.center, self.size * inner.size)

    @property
    def outwards(self) -> FloatArray:
        """Return the unit to outer frame, shape [4, 4]."""
        matrix = np.eye(4) * self.size
        matrix[:3, 3] = self.center
        matrix[3, 3] = 1.0
        return matrix
