"""Panels without a seam between them, cut half-way between their handles."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .handles import Protrusion
from .rectangles import Lines, Rectangle

#: A line that is covered so far between two handles is taken for the seam.
WEAK = 0.3
#: Handles must be that far apart, as a share of what they divide.
LEAST_GAP = 0.01


def divided(
    rectangle: Rectangle, handles: Sequence[Protrusion], level: Lines, upright: Lines
) -> list[tuple[Rectangle, Protrusion]]:
    """A rectangle cut so that every piece has one handle; nothing if that cannot be.

    Args:
        rectangle: what is to be cut.
        handles: the pulls in it.
        level: candidate lines, of which weak ones are good enough here.
        upright: likewise, vertical ones.
    """
    if len(handles) == 1:
        return [(rectangle, handles[0])]
    gaps = [_widest_gap(rectangle, handles, axis) for axis in (0, 1)]
    axis = 0 if gaps[0][0] >= gaps[1][0] else 1
    share, start, stop = gaps[axis]
    if share < LEAST_GAP:
        return []
    at = _seam_between((level, upright)[axis], rectangle, axis, start, stop)
    lower, upper = _halves(rectangle, axis, at)
    below = [handle for handle in handles if handle.center[axis] < at]
    above = [handle for handle in handles if handle.center[axis] >= at]
    pieces = [divided(lower, below, level, upright), divided(upper, above, level, upright)]
    return [*pieces[0], *pieces[1]] if pieces[0] and pieces[1] else []


def _widest_gap(
    rectangle: Rectangle, handles: Sequence[Protrusion], axis: int
) -> tuple[float, float, float]:
    """Between neighbours along an axis: its share of the rectangle, where it starts and ends."""
    ordered = sorted(handles, key=lambda handle: float(handle.low[axis]))
    reach = float(ordered[0].high[axis])
    best = (-1.0, reach, reach)
    for handle in ordered[1:]:
        gap = (float(handle.low[axis]) - reach) / max(float(rectangle.size[axis]), 1.0)
        if gap > best[0]:
            best = (gap, reach, float(handle.low[axis]))
        reach = max(reach, float(handle.high[axis]))
    return best


def _seam_between(lines: Lines, rectangle: Rectangle, axis: int, start: float, stop: float) -> int:
    between = np.flatnonzero((lines.at > start) & (lines.at < stop))
    if len(between):
        cover = lines.covered(between, rectangle.low[1 - axis], rectangle.high[1 - axis])
        if cover.max() >= WEAK:
            return int(lines.at[between[cover.argmax()]])
    return round((start + stop) / 2.0)


def _halves(rectangle: Rectangle, axis: int, at: int) -> tuple[Rectangle, Rectangle]:
    middle_high = rectangle.high.copy()
    middle_low = rectangle.low.copy()
    middle_high[axis] = at
    middle_low[axis] = at
    unseen = np.zeros(4)
    return (
        Rectangle(rectangle.low, middle_high, unseen, unseen),
        Rectangle(middle_low, rectangle.high, unseen, unseen),
    )
