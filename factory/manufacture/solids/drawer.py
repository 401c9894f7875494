"""The box behind a drawer's front: a bottom, two sides and a back, clear of the carcass."""

from __future__ import annotations

import numpy as np

from .box import Box

#: Between the box and the hollow that it slides in, each side [m].
CLEAR_M = 0.003
#: The box ends this far before the hollow's back [m].
STOP_M = 0.006
#: Share of the hollow's height.
HEIGHT = 0.85
BOTTOM_M = 0.008
WALL_M = 0.01
#: A box that would be lower or narrower is none [m].
LEAST_M = 0.016


def drawer_box(hollow: Box, back: float, up: int = 1) -> tuple[Box, ...]:
    """Return the boards of a drawer's box.

    Args:
        hollow: that it slides in, in the frame of the drawer's front: right, up, away.
        back: depth of the front's back, to which bottom and sides reach [m].
        up: the frame's axis that points up.

    Returns:
        Bottom, left, right and back, in the same frame; none where there is no room.
    """
    low = hollow.low + CLEAR_M
    high = hollow.high - np.array([CLEAR_M, CLEAR_M, STOP_M])
    low[2] = back
    high[up] = low[up] + HEIGHT * (high[up] - low[up])
    if (high - low).min() < LEAST_M:
        return ()
    across = 1 - up
    outer = Box(low, high)
    bottom = _part(outer, up, low[up], low[up] + BOTTOM_M)
    above = _part(outer, up, low[up] + BOTTOM_M, high[up])
    left = _part(above, across, low[across], low[across] + WALL_M)
    right = _part(above, across, high[across] - WALL_M, high[across])
    between = _part(above, across, low[across] + WALL_M, high[across] - WALL_M)
    return bottom, left, right, _part(between, 2, high[2] - WALL_M, high[2])


def _part(box: Box, axis: int, start: float, end: float) -> Box:
    """Return the part of a box between two planes across an axis [m]."""
    low = box.low.copy()
    high = box.high.copy()
    low[axis] = start
    high[axis] = end
    return Box(low, high)
