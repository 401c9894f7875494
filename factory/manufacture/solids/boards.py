"""Boards behind a panel: a drawer's box, clear of the carcass, and the shelves behind a door."""

from __future__ import annotations

import numpy as np

from .box import Box
from .sweep import CLEAR_M

#: The box ends this far before the hollow's back [m].
STOP_M = 0.006
#: Share of the hollow's height.
HEIGHT = 0.85
BOTTOM_M = 0.008
WALL_M = 0.01
#: Of a shelf; a box that would be lower or narrower is none [m].
SHELF_M = 0.016
#: Before a shelf there is room for what a door holds on its inner side [m].
SETBACK_M = 0.03


def drawer_box(hollow: Box, back: float, up: int = 1) -> tuple[Box, ...]:
    """Return the boards of a drawer's box: bottom, left, right and back; none without room.

    The hollow that it slides in and the boards are in the frame of the drawer's front: right, up,
    away; ``up`` is the axis that points up. Bottom and sides reach to the front's ``back`` [m].
    """
    low = hollow.low + CLEAR_M
    high = hollow.high - np.array([CLEAR_M, CLEAR_M, STOP_M])
    low[2] = back
    high[up] = low[up] + HEIGHT * (high[up] - low[up])
    if (high - low).min() < SHELF_M:
        return ()
    across = 1 - up
    outer = Box(low, high)
    bottom = outer.between(low[up], low[up] + BOTTOM_M, up)
    above = outer.between(low[up] + BOTTOM_M, high[up], up)
    left = above.between(low[across], low[across] + WALL_M, across)
    right = above.between(high[across] - WALL_M, high[across], across)
    inner = above.between(low[across] + WALL_M, high[across] - WALL_M, across)
    return bottom, left, right, inner.between(high[2] - WALL_M, high[2])


def shelf_boards(hollow: Box, spacing: float, up: int = 1) -> tuple[Box, ...]:
    """Return the shelves that hold the walls of a hollow apart, the lowest first.

    The hollow and the boards are in the frame of the door: right, up, away; ``up`` is the axis that
    points up. None where the hollow is lower than one and a half of the usual spacing of shelves
    [m], or too shallow.
    """
    inner = hollow.between(hollow.low[2] + SETBACK_M, hollow.high[2])
    if inner.size.min() <= 2.0 * SHELF_M:
        return ()
    rooms = max(round(float(inner.size[up]) / spacing), 1)
    heights = np.linspace(inner.low[up], inner.high[up], rooms + 1)[1:-1]
    half = 0.5 * SHELF_M
    return tuple(inner.between(at - half, at + half, up) for at in heights.tolist())
