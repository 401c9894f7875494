"""Panels that were found between two planks, as far as the picture network sees them go."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from .fronts import Front
from .groups import FrontPanel, apart
from .rectangles import Rectangle

#: Where an end is less sure, a panel may go on; to the next line where one is so sure.
WEAK = 0.45
STRONG = 0.6
#: It goes on over what shows so much of a panel, and no handle.
WITHIN = 0.6
#: No plank is so narrow [pixels]: that is a frame.
NARROW = 14


def beyond_planks(front: Front, panels: Sequence[FrontPanel]) -> list[FrontPanel]:
    """Panels whose sides lie where something surely ends; none without a handle lies in others.

    Args:
        front: the side.
        panels: that were found there.
    """
    pulled = [panel for panel in panels if panel.handles]
    for index, panel in enumerate(pulled):
        others = [other.rectangle for other in pulled if other is not panel]
        pulled[index] = _grown(front, panel, others)
    whole = [panel.rectangle for panel in pulled]
    bare = [panel for panel in panels if not panel.handles]
    clear = (panel for panel in bare if all(apart(panel.rectangle, each) for each in whole))
    return [*pulled, *clear]


def _grown(front: Front, panel: FrontPanel, others: Sequence[Rectangle]) -> FrontPanel:
    rectangle = panel.rectangle
    for axis in (0, 1):
        for upper in (False, True):
            if front.sight.ends(rectangle)[2 * axis + upper] < WEAK:
                rectangle = _moved(front, rectangle, others, axis, upper=upper)
    return panel if rectangle is panel.rectangle else replace(panel, rectangle=rectangle)


def _moved(
    front: Front, rectangle: Rectangle, others: Sequence[Rectangle], axis: int, *, upper: bool
) -> Rectangle:
    """With one side where the next sure end is; the same if something else comes first."""
    lines = (front.scene.level, front.scene.upright)[axis].at
    at = (rectangle.high if upper else rectangle.low)[axis]
    beyond = lines[lines > at + NARROW] if upper else lines[lines < at - NARROW][::-1]
    for line in beyond:
        wider = _with_side(rectangle, axis, line, upper=upper)
        strip = _with_side(wider, axis, at, upper=not upper)
        if not all(apart(wider, other) for other in others):
            break
        pulled = any(strip.holds(pull.center) for pull in front.scene.face.pulls)
        if pulled or front.sight.shows(strip) < WITHIN:
            break
        if front.sight.ends(wider)[2 * axis + upper] >= STRONG:
            return wider
    return rectangle


def _with_side(rectangle: Rectangle, axis: int, at: int, *, upper: bool) -> Rectangle:
    low = rectangle.low.copy()
    high = rectangle.high.copy()
    (high if upper else low)[axis] = at
    return replace(rectangle, low=low, high=high)
