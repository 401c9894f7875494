"""Where a lid is hinged: beside the seam, across from its latch, above wheels."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from scipy import ndimage

from ...views.raster import Side
from .fronts import AROUND, OPPOSITE, Front

#: A seam that is covered less is not seen on a side.
LEAST_SIDE = 0.3
#: How far the seam may wander up and down [pixels].
WANDER = 3
#: A latch or a handle lies within this share of the height of the seam, or above it; of the side's
#: width it takes at most so much, and lies near its middle (1), where hinges lie near its ends (0).
LATCH_REACH = 0.1
LATCH_WIDTH = 0.4
CENTRAL = 0.6
#: Hinges are at most so wide, as a share of the side's width.
HINGE_WIDTH = 0.2
#: A pedal is what lies within so much of the nearest of a foot [pixels].
NEAREST = 4.0
#: What speaks for a side whose seam alone is not seen, which has hinges, or a latch across; and for
#: one below which wheels reach out.
UNSEEN = 1.5
HINGED = 1.0
LATCHED = 1.2
WHEELED = 2.0
#: Fronts mostly face -Y or +X, so that lids are mostly hinged across from there.
USUAL_HINGE = {Side.BACK: 0.3, Side.LEFT: 0.2, Side.FRONT: 0.0, Side.RIGHT: 0.0}


def lid_hinges(fronts: Mapping[Side, Front], row: int) -> tuple[Side, ...]:
    """Return the sides on which a lid may be hinged, the likeliest first.

    Args:
        fronts: the four sides.
        row: of its seam in their pictures; the same in all.
    """
    first, last, _, _ = fronts[Side.FRONT].relief.box
    height = last - first
    covers = {side: _cover(fronts[side], row) for side in AROUND}
    hidden = min(covers, key=covers.__getitem__)
    widths = {side: _width(fronts[side], row) for side in AROUND}
    longest = max(*widths.values(), 1)
    value = {}
    for side in AROUND:
        front = fronts[side]
        value[side] = USUAL_HINGE[side] + 3.0 * (widths[side] / longest - 1.0)
        value[side] += UNSEEN * (side is hidden and covers[side] < LEAST_SIDE)
        value[side] += HINGED * _has_hinges(front, row, height)
        value[side] += LATCHED * _latch(fronts[OPPOSITE[side]], row, height)
        value[side] -= LATCHED * _latch(front, row, height)
        value[side] += WHEELED * _foot(fronts, side, first, height)
    return tuple(sorted(value, key=lambda each: -value[each]))


def _cover(front: Front, row: int) -> float:
    """Return the share of a row's length that shows a seam."""
    rows = slice(max(row - WANDER, 0), row + WANDER + 1)
    seams = front.seams
    wide = (seams.all * seams.known)[rows].max(axis=0)
    inner = ndimage.binary_erosion(front.relief.seen[row : row + 1], np.ones((1, 5), np.bool_))[0]
    known = inner & (seams.known[row] > 0.5)
    return float((wide * known).sum() / max(known.sum(), 1))


def _width(front: Front, row: int) -> int:
    """Return how far the rows beside a seam span [pixels]."""
    spans = [np.flatnonzero(each) for each in front.relief.seen[max(row - 2, 0) : row + 3]]
    return max((int(each[-1] - each[0]) + 1 for each in spans if len(each)), default=0)


def _at_seam(front: Front, row: int, height: int, widest: float) -> list[tuple[float, float]]:
    """Return how central each handle at a seam is, 0 to 1, and on which half, -1 or 1.

    Args:
        front: the side.
        row: of the seam.
        height: of the object [pixels].
        widest: share of the side's width that it takes at most.
    """
    _, _, left, right = front.relief.box
    middle = (left + right) / 2.0
    half = max((right - left) / 2.0, 1.0)
    aside = [
        (float(handle.center[1]) - middle) / half
        for handle in front.face.handles
        if handle.high[0] >= row - LATCH_REACH * height and handle.size[1] <= 2.0 * widest * half
    ]
    return [(1.0 - abs(each), float(np.sign(each))) for each in aside]


def _latch(front: Front, row: int, height: int) -> float:
    """Return how central the most central latch of a side is, 0 to 1; 0 without one."""
    found = [central for central, _ in _at_seam(front, row, height, LATCH_WIDTH)]
    return max((each for each in found if each >= CENTRAL), default=0.0)


def _has_hinges(front: Front, row: int, height: int) -> bool:
    """Return whether something small sits at the seam towards both ends of a side."""
    found = _at_seam(front, row, height, HINGE_WIDTH)
    return {half for central, half in found if central < CENTRAL} == {-1.0, 1.0}


def _foot(fronts: Mapping[Side, Front], side: Side, first: int, height: int) -> float:
    """Return how far wheels reach out at the foot of a side, below a hinge, -1 to 1.

    A pedal reaches out on the other side: it has no ends beyond the middle.
    """
    reach = _reach(fronts, side, first, height)
    out = side if reach > 0.0 else OPPOSITE[side]
    return -reach if _has_pedal(fronts[out], first, height) else reach


def _reach(fronts: Mapping[Side, Front], side: Side, first: int, height: int) -> float:
    """Return how much further a foot reaches out to a side than to the opposite one, -1 to 1."""
    view = Side.FRONT if side in (Side.LEFT, Side.RIGHT) else Side.RIGHT
    relief = fronts[view].relief
    foot = np.flatnonzero(relief.seen[first : first + max(height // 8, 1)].any(axis=0))
    upper = np.flatnonzero(relief.seen[first + height // 4 : first + height // 2].any(axis=0))
    if not len(foot) or not len(upper):
        return 0.0
    reach_left = float(upper[0] - foot[0])
    reach_right = float(foot[-1] - upper[-1])
    offset = (reach_right - reach_left) / max(float(len(upper)), 1.0)
    to_right = side in (Side.RIGHT, Side.BACK)
    return float(np.clip(10.0 * (offset if to_right else -offset), -1.0, 1.0))


def _has_pedal(front: Front, first: int, height: int) -> bool:
    """Tell whether the nearest point at the foot of a side is in its middle."""
    relief = front.relief
    foot = np.where(relief.seen, relief.height, -np.inf)[first : first + max(height // 8, 1)]
    nearest = np.flatnonzero((foot > foot.max() - NEAREST).any(axis=0))
    _, _, left, right = relief.box
    middle = np.abs(nearest - (left + right) / 2.0) / max((right - left) / 2.0, 1.0)
    return bool(middle.max() < 1.0 - CENTRAL)
