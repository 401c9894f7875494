"""What turns is cut free by surfaces of revolution about its axis, which fit it at every angle.

A knob of twelve sides on a flat panel, or in a ring of twelve, has to be clear of it however it is
turned. Planes found pose by pose cut it from every side; a cylinder, or a plane across the axis, is
one cut.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from ...articulation import Joint
from ...asset import Hull
from ...mesh import FloatArray
from ..poses import arms_from
from .along import Step, cut_apart_along, hull_depth, when_near
from .clip import ROUNDING_M, ROUNDING_SHARE, SHARES, clipped

#: A cylinder is cut as a prism of so many sides.
SIDES = 72

Hulls = tuple[Hull | None, Hull | None]


@dataclass(frozen=True)
class Turned:
    """Cuts two parts apart about the axis of a joint that turns one in the other.

    Attributes:
        joint: of the two.
    """

    joint: Joint

    def __call__(
        self, a: Sequence[Hull], b: Sequence[Hull], poses: Sequence[FloatArray], clearance_m: float
    ) -> tuple[list[Hull], list[Hull]]:
        """See :func:`~.along.cut_apart_along`, which cuts hulls still too near afterwards."""
        ones: list[Hull | None] = list(a)
        others: list[Hull | None] = list(b)
        for (i, j), way in when_near(a, b, map(Step, poses), clearance_m):
            one = ones[i]
            other = others[j]
            if one is None or other is None:
                continue
            depths = (hull_depth([one], [other], step.pose, clearance_m) for step in way)
            if any(depth > ROUNDING_M - clearance_m for depth in depths):
                ones[i], others[j] = self._best(one, other, clearance_m)
        first, second = (list(filter(None, hulls)) for hulls in (ones, others))
        return cut_apart_along(first, second, poses, clearance_m)

    def _best(self, one: Hull, other: Hull, clearance_m: float) -> Hulls:
        """Cut two hulls apart across the axis or around it, off either or both: what leaves most.

        Of cuts that leave as much the first.
        """
        best: Hulls = (None, None)
        most = -np.inf
        cuts = (self._across, self._around)
        for share, cut, turned in product(SHARES, cuts, (False, True)):
            if turned:
                found = cut(other, one, clearance_m, 1.0 - share, most)[::-1]
            else:
                found = cut(one, other, clearance_m, share, most)
            left = _volume(found)
            if left > most:
                best = found
                most = left
        return best

    def _across(
        self, below: Hull, above: Hull, clearance_m: float, share: float, most: float
    ) -> Hulls:
        """Return one hull on either side of a plane across the axis; ``share`` goes off the first.

        Nothing, where the rest would be less than ``most`` [m3].
        """
        axis = self.joint.axis
        end = float((below.vertices @ axis).max())
        start = float((above.vertices @ axis).min())
        needed = max(0.0, end - start + clearance_m)
        first = clipped(below, axis, end - share * needed)
        if _less((first, above), most):
            return None, None
        return first, clipped(above, -axis, -(start + (1.0 - share) * needed))

    def _around(
        self, inner: Hull, outer: Hull, clearance_m: float, share: float, most: float
    ) -> Hulls:
        """Return the first within a cylinder, the other without it; ``share`` goes off the first.

        Nothing, where the rest would be less than ``most`` [m3].
        """
        arms = arms_from(self.joint, outer.vertices)
        toward = arms.mean(axis=0)
        length = float(np.linalg.norm(toward))
        if length == 0.0:
            return None, None
        toward = toward / length
        start = float((arms @ toward).min())
        end = float(np.linalg.norm(arms_from(self.joint, inner.vertices), axis=1).max())
        needed = max(0.0, end - start + clearance_m)
        least = start + (1.0 - share) * needed + float(self.joint.origin @ toward)
        second = clipped(outer, -toward, -least)
        return self._within(inner, end - share * needed, second, most), second

    def _within(self, hull: Hull, radius_m: float, other: Hull | None, most: float) -> Hull | None:
        """Return what of a hull lies in a cylinder about the axis; see :meth:`_around`."""
        first, second = np.linalg.svd(self.joint.axis[None])[2][1:]
        left: Hull | None = hull if radius_m > 0.0 else None
        for angle in np.arange(SIDES) * 2.0 * np.pi / SIDES:
            # Each side takes some: most cylinders need not be cut to their end.
            if left is None or _less((left, other), most):
                return None
            normal = np.cos(angle) * first + np.sin(angle) * second
            left = clipped(left, normal, radius_m + float(self.joint.origin @ normal))
        return left


def _volume(hulls: Hulls) -> float:
    """Return the remaining volume of two hulls [m3]."""
    return sum(hull.volume for hull in hulls if hull is not None)


def _less(hulls: Hulls, most: float) -> bool:
    """Tell whether two hulls are less than ``most`` [m3], by more than rounding."""
    return _volume(hulls) < most - ROUNDING_SHARE * abs(most)
