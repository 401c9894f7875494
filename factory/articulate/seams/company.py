"""What panels say of each other: pairs of doors, chests of drawers."""

from __future__ import annotations

from collections.abc import Sequence

from ...part import OpensBy
from .features import ALIGNED
from .groups import FrontPanel
from .handles import GripShape

#: Three drawers make a chest; on two, an oven's door may be above a drawer.
CHEST = 3
#: Doors of a pair differ in width by at most this ratio, have so much of their height in common,
#: and are so tall for their width.
ALIKE = 1.3
LEVEL = 0.85
TALL = 0.9
#: A bar from this share of a panel's height on is at its top.
TOP = 0.7
#: By how much the log-weight of a way changes.
UNLIKELY = -4.0
LESS_LIKELY = -1.5
LIKELIER = 1.5


def said_by_company(
    panels: Sequence[FrontPanel], *, has_controls: bool
) -> list[dict[OpensBy, float]]:
    """Return what each panel's company adds to the log-weights of its ways to open.

    A bar at the top pulls a dishwasher's door down. But of two tall panels beside each other it
    opens doors, and of three above each other drawers; an appliance, which has knobs, may have
    anything.

    Args:
        panels: of one side.
        has_controls: whether it has a row of knobs.
    """
    if has_controls:
        return [{} for _ in panels]
    return [_said(panel, panels) for panel in panels]


def _said(panel: FrontPanel, panels: Sequence[FrontPanel]) -> dict[OpensBy, float]:
    beside = [other for other in panels if other is not panel and _pair(panel, other)]
    if beside:
        left = any(other.rectangle.low[1] < panel.rectangle.low[1] for other in beside)
        right = any(other.rectangle.low[1] > panel.rectangle.low[1] for other in beside)
        hinges = {OpensBy.LEFT: LIKELIER * (not left), OpensBy.RIGHT: LIKELIER * (not right)}
        unlikely = {OpensBy.BOTTOM: UNLIKELY, OpensBy.TOP: UNLIKELY, OpensBy.OUT: LESS_LIKELY}
        return hinges | unlikely
    stacked = [other for other in panels if _stacked(panel, other)]
    if len(stacked) >= CHEST and all(_is_pulled(other) for other in stacked):
        return {OpensBy.BOTTOM: UNLIKELY, OpensBy.TOP: UNLIKELY}
    return {}


def _pair(one: FrontPanel, other: FrontPanel) -> bool:
    """Tell whether two are tall, alike, side by side, each with a level bar at its top."""
    if not (_has_bar_on_top(one) and _has_bar_on_top(other)):
        return False
    both = (one.rectangle, other.rectangle)
    widths = [float(each.size[1]) for each in both]
    heights = [float(each.size[0]) for each in both]
    common = _common(one, other)
    tall = min(heights[0] / widths[0], heights[1] / widths[1]) >= TALL
    return tall and max(widths) <= ALIKE * min(widths) and common >= LEVEL * max(heights)


def _common(one: FrontPanel, other: FrontPanel) -> float:
    """Return how much of their heights two have in common [pixels]."""
    both = (one.rectangle, other.rectangle)
    return min(float(each.high[0]) for each in both) - max(float(each.low[0]) for each in both)


def _has_bar_on_top(panel: FrontPanel) -> bool:
    if panel.handle is None or panel.handle.grip is not GripShape.LEVEL:
        return False
    above = float(panel.handle.center[0] - panel.rectangle.low[0])
    return above >= TOP * float(panel.rectangle.size[0])


def _stacked(one: FrontPanel, other: FrontPanel) -> bool:
    """Return whether two have the same columns; a panel has its own."""
    low = abs(one.rectangle.low[1] - other.rectangle.low[1])
    high = abs(one.rectangle.high[1] - other.rectangle.high[1])
    return bool(max(low, high) <= ALIGNED)


def _is_pulled(panel: FrontPanel) -> bool:
    return panel.handle is not None and panel.handle.grip is not GripShape.UPRIGHT
