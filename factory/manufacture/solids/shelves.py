"""Shelves in a hollow behind a door, at even heights between its floor and its ceiling."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .box import Box

THICKNESS_M = 0.016
#: Before a shelf there is room for what a door holds on its inner side [m].
SETBACK_M = 0.03


def shelf_boards(hollows: Sequence[Box], spacing: float, up: int = 1) -> tuple[Box, ...]:
    """Return the shelves that hold the walls of a hollow apart.

    Args:
        hollows: its boxes behind one another, in the frame of the door: right, up, away.
        spacing: usual distance between two shelves [m].
        up: the frame's axis that points up.

    Returns:
        Boards in the same frame, the lowest first; none where the hollow is lower than one and a
        half of the distance, or too shallow.
    """
    low = np.max([box.low for box in hollows], axis=0)
    low[2] = hollows[0].low[2] + SETBACK_M
    high = np.min([box.high for box in hollows], axis=0)
    high[2] = hollows[-1].high[2]
    if (high - low).min() <= 2.0 * THICKNESS_M:
        return ()
    rooms = max(round(float(high[up] - low[up]) / spacing), 1)
    heights = np.linspace(low[up], high[up], rooms + 1)[1:-1]
    return tuple(_board(low, high, up, float(height)) for height in heights)


def _board(low: np.ndarray, high: np.ndarray, up: int, height: float) -> Box:
    """Return a board about one height [m], between two corners."""
    ends = np.stack([low, high])
    ends[:, up] = height + np.array([-0.5, 0.5]) * THICKNESS_M
    return Box(*ends)
