"""Panels of which the picture network alone is sure, cut along the ends that it sees."""

from __future__ import annotations

import numpy as np
from scipy import ndimage

from ...mesh import FloatArray, IntArray
from .candidates import main_pulls
from .fronts import Front
from .groups import FrontPanel
from .panels import STRICT
from .rectangles import Rectangle
from .sight import SQUARE, Block, Sight

#: A square belongs to a panel from this probability.
LIKELY = 0.4
#: A side is cut where squares are an end with this probability in the mean.
END = 0.35
#: With fewer squares of panels nothing is cut, nor rows or columns that hold fewer.
LEAST_SQUARES = 60
LEAST_IN_LINE = 3
#: A panel is at least so wide and high [squares].
LEAST = 6
#: What is seen must be so sure, and end at its sides so surely, to be a panel of so many pulls.
SURE = 0.8
ENDS = 0.6
MOST_PULLS = 2
#: One of a row of controls may be a panel's only pull; what holds more is where they sit.
MOST_CONTROLS = 1

#: A panel ends at most so far within what it was cut along [squares].
REACH = 4
#: Lines are seen more exactly than squares [pixels].
SNAP = 4


def glimpsed(front: Front) -> tuple[FrontPanel, ...]:
    """Return the panels of one side that the network alone is sure of."""
    likely = front.sight.panel > LIKELY
    rows = np.flatnonzero(likely.sum(axis=1) >= LEAST_IN_LINE)
    columns = np.flatnonzero(likely.sum(axis=0) >= LEAST_IN_LINE)
    if likely.sum() < LEAST_SQUARES or not len(rows) or not len(columns):
        return ()
    whole = (int(rows[0]), int(rows[-1]) + 1, int(columns[0]), int(columns[-1]) + 1)
    level = ndimage.maximum_filter1d(front.sight.level, 3, axis=0)
    upright = ndimage.maximum_filter1d(front.sight.upright, 3, axis=1)
    panels = (_panel(front, block) for block in _blocks(whole, level, upright))
    return tuple(panel for panel in panels if panel is not None)


def _blocks(block: Block, level: FloatArray, upright: FloatArray) -> list[Block]:
    """Return the rest of a block when it is cut along its surest end, and so on."""
    bottom, top, left, right = block
    rows = level[bottom + LEAST : top - LEAST + 1, left:right].mean(axis=1)
    columns = upright[bottom:top, left + LEAST : right - LEAST + 1].mean(axis=0)
    highest = max(rows.max(initial=0.0), columns.max(initial=0.0))
    if highest <= END:
        return [block]
    if rows.max(initial=0.0) == highest:
        at = bottom + LEAST + _middle(rows)
        halves = (bottom, at, left, right), (at, top, left, right)
    else:
        at = left + LEAST + _middle(columns)
        halves = (bottom, top, left, at), (bottom, top, at, right)
    return [found for half in halves for found in _blocks(half, level, upright)]


def _middle(profile: FloatArray) -> int:
    """Return where a profile is highest; in the middle, where it stays as high for a while."""
    around = ndimage.uniform_filter1d(profile, 3, mode="nearest")
    return int(np.where(profile == profile.max(), around, -np.inf).argmax())


def _panel(front: Front, block: Block) -> FrontPanel | None:
    """Return a block, if the network is sure of it."""
    block = _settled(front.sight, block)
    sides = front.sight.ends_of(block)
    lines = front.scene.level.at, front.scene.upright.at
    low, high = (
        np.array([_snapped(SQUARE * at, near) for at, near in zip(corner, lines, strict=True)])
        for corner in (block[::2], block[1::2])
    )
    high = np.minimum(high, np.array(front.relief.shape) - 1)
    rectangle = Rectangle(low, high, sides, sides)
    sure = front.sight.shows(rectangle)
    if (high - low).min() < SQUARE * LEAST or sure < SURE or sides.mean() < ENDS:
        return None
    if front.relief.seen[low[0] : high[0], low[1] : high[1]].mean() < STRICT.solid:
        return None
    handles = front.scene.handles_in(rectangle)
    if len(main_pulls(handles, rectangle)) > MOST_PULLS:
        return None
    controls = [each for each in front.scene.face.handles if each.control]
    if not handles and sum(rectangle.holds(each.center) for each in controls) > MOST_CONTROLS:
        return None
    odds = float(np.log(sure / (1.0 - sure))) if sure < 1.0 else np.inf
    return FrontPanel(rectangle, handles, odds)


def _snapped(at: int, lines: IntArray) -> int:
    """Return the nearest line, if it is near [pixels]."""
    nearest = int(lines[np.abs(lines - at).argmin()])
    return nearest if abs(nearest - at) <= SNAP else at


def _settled(sight: Sight, block: Block) -> Block:
    """Return a block whose sides have moved in to the surest end near each."""
    bottom, top, left, right = block
    rows = sight.level[bottom:top, left:right].mean(axis=1)
    columns = sight.upright[bottom:top, left:right].mean(axis=0)
    if min(len(rows), len(columns)) < 2 * REACH:
        return block
    return (
        bottom + int(rows[:REACH].argmax()),
        top - int(rows[::-1][:REACH].argmax()),
        left + int(columns[:REACH].argmax()),
        right - int(columns[::-1][:REACH].argmax()),
    )
