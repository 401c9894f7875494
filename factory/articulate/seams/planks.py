"""Panels that were found between two planks, as far as the picture network sees them go."""

from collections.abc import Sequence
from dataclasses import replace

from .fronts import Front
from .groups import FrontPanel, clear_of

#: Where an end is less sure, a panel may go on; to the next line where one is so sure.
WEAK = 0.45
STRONG = 0.6
#: It goes on over what shows so much of a panel, and no handle.
WITHIN = 0.6
#: No plank is so narrow [pixels]: that is a frame.
NARROW = 14


def beyond_planks(front: Front, panels: Sequence[FrontPanel]) -> list[FrontPanel]:
    """Move sides of panels to where something surely ends; drop bare ones within others.

    Args:
        front: the side.
        panels: that were found there.
    """
    pulled = [panel for panel in panels if panel.handles]
    for index, panel in enumerate(pulled):
        pulled[index] = _grown(front, panel, [other for other in pulled if other is not panel])
    bare = [panel for panel in panels if not panel.handles]
    return [*pulled, *clear_of(bare, pulled)]


def _grown(front: Front, panel: FrontPanel, others: Sequence[FrontPanel]) -> FrontPanel:
    found = panel
    for side in range(4):
        if front.sight.ends(found.rectangle)[side] < WEAK:
            found = _moved(front, found, others, side)
    return found


def _moved(front: Front, panel: FrontPanel, others: Sequence[FrontPanel], side: int) -> FrontPanel:
    """Move one side to the next sure end, unless something else comes first."""
    axis, upper = divmod(side, 2)
    whole = panel.rectangle
    lines = (front.scene.level, front.scene.upright)[axis].at
    at = (whole.high if upper else whole.low)[axis]
    for line in lines[lines > at + NARROW] if upper else lines[lines < at - NARROW][::-1]:
        wider = replace(panel, rectangle=whole.with_side(side, line))
        strip = wider.rectangle.with_side(side ^ 1, at)
        pulled = any(strip.holds(pull.center) for pull in front.scene.face.pulls)
        if pulled or not clear_of([wider], others) or front.sight.shows(strip) < WITHIN:
            break
        if front.sight.ends(wider.rectangle)[side] >= STRONG:
            return wider
    return panel
