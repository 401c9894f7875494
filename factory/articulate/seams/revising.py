"""What the picture network changes about panels that somebody else found on a side."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from .candidates import in_common
from .fronts import Front
from .glimpses import glimpsed
from .groups import FrontPanel, clear_of
from .handles import LONGEST_KNOB
from .panels import rated
from .planks import beyond_planks
from .rectangles import CLOSED, LEFT, RIGHT, Rectangle
from .sight import SQUARE

#: Of a panel of which the network sees less, another rectangle with the same handle may be better:
#: one of which it sees so much, with less in common (intersection over union).
DOUBTED = 0.6
SURE = 0.7
OTHER = 0.7
#: Where nobody saw a seam between panels, the network must see so many there, and so much of them.
FEWEST = 2
MOST_OF = 0.75
#: What the network sees may lie over another panel so far, as a share of its own size: its ends
#: are a few pixels off.
STRIP = 0.15
#: Two knobs that have grown together are at most so wide, as a share of both doors; between these
#: shares of the width, so sure an end parts the doors.
GROWN = 0.25
MIDDLE = (0.4, 0.6)
PARTED = 0.45


def revised(
    front: Front, panels: Sequence[FrontPanel], found: Sequence[Rectangle]
) -> list[FrontPanel]:
    """Return panels as the network sees them where it is sure, and others that it sees.

    Args:
        front: the side.
        panels: that were found there; their values are log-odds.
        found: rectangles that are closed by seams.
    """
    glimpses = glimpsed(front)
    others = [
        group.panels[0] for group in rated(front.scene, found) if group.rectangle.closed >= CLOSED
    ]
    halves = [half for panel in panels for half in _parted(front, panel)]
    whole = beyond_planks(front, halves)
    kept = _exchanged(front, _recut(whole, glimpses), [*glimpses, *others])
    return [*kept, *clear_of([_cut_back(each, kept) for each in glimpses], kept)]


def _parted(front: Front, panel: FrontPanel) -> tuple[FrontPanel, ...]:
    """Return two doors, if the network sees an end behind the only knob, then shared."""
    whole = panel.rectangle
    if len(panel.handles) != 1:
        return (panel,)
    knob = panel.handles[0]
    rows, columns = knob.size
    if columns > min(LONGEST_KNOB * rows, GROWN * whole.size[1]):
        return (panel,)
    inside = slice(whole.low[0] // SQUARE + 1, whole.high[0] // SQUARE)
    ends = front.sight.upright[inside]
    sure = np.maximum(ends[:, :-1], ends[:, 1:]).mean(axis=0)
    at = SQUARE * (np.arange(len(sure)) + 1)
    share = (at - whole.low[1]) / whole.size[1]
    behind = (at > knob.low[1]) & (at < knob.high[1]) & (share > MIDDLE[0]) & (share < MIDDLE[1])
    sure = np.where(behind, sure, 0.0)
    if sure.max() < PARTED:
        return (panel,)
    seam = int(at[sure.argmax()])
    on_left, on_right = knob.split(seam)
    return (
        replace(panel, rectangle=whole.with_side(RIGHT, seam), handles=(on_left,)),
        replace(panel, rectangle=whole.with_side(LEFT, seam), handles=(on_right,)),
    )


def _recut(panels: Sequence[FrontPanel], glimpses: Sequence[FrontPanel]) -> list[FrontPanel]:
    """Cut where the network sees ends instead of half-way between handles."""
    cut = [panel for panel in panels if panel.cut]
    kept = [panel for panel in panels if not panel.cut]
    own = [each for each in clear_of(glimpses, kept) if not clear_of([each], cut)]
    held = all(any(each.rectangle.holds(panel.handles[0].center) for each in own) for panel in cut)
    enough = _area(own) >= MOST_OF * _area(cut)
    return [*kept, *own] if held and enough and len(own) >= FEWEST else list(panels)


def _exchanged(
    front: Front, panels: Sequence[FrontPanel], others: Sequence[FrontPanel]
) -> list[FrontPanel]:
    """Exchange panels that the network doubts for rectangles around the same handle."""
    kept = list(panels)
    for index, panel in enumerate(panels):
        if front.sight.shows(panel.rectangle) >= DOUBTED:
            continue
        rest = [*kept[:index], *kept[index + 1 :]]
        fit = [
            each.rectangle
            for each in clear_of(others, rest)
            if panel.handle in each.handles
            and front.sight.shows(each.rectangle) >= SURE
            and in_common(panel.rectangle, each.rectangle) < OTHER
        ]
        if fit:
            kept[index] = replace(panel, rectangle=max(fit, key=lambda each: each.area))
    return kept


def _cut_back(panel: FrontPanel, others: Sequence[FrontPanel]) -> FrontPanel:
    """Cut off a narrow strip along one side that it shares with another panel."""
    whole = panel.rectangle
    found = whole
    for other in (each.rectangle for each in others):
        if not whole.shared(other):
            continue
        for axis in (0, 1):
            most = STRIP * whole.size[axis]
            if 0 < other.high[axis] - found.low[axis] <= most:
                found = found.with_side(2 * axis, other.high[axis])
                break
            if 0 < found.high[axis] - other.low[axis] <= most:
                found = found.with_side(2 * axis + 1, other.low[axis])
                break
    return replace(panel, rectangle=found)


def _area(panels: Sequence[FrontPanel]) -> float:
    return sum(panel.rectangle.area for panel in panels)
