"""What the picture network changes about panels that somebody else found on a side."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from .candidates import in_common
from .fronts import Front
from .glimpses import glimpsed
from .groups import FrontPanel, apart
from .panels import rated
from .rectangles import Rectangle

#: Of a panel of which the network sees less, another rectangle with the same handle may be better:
#: one of which it sees so much, so closed by seams, with less in common (intersection over union).
DOUBTED = 0.6
SURE = 0.7
CLOSED = 0.8
OTHER = 0.7
#: Where nobody saw a seam between panels, the network must see so many there, and so much of them.
FEWEST = 2
MOST_OF = 0.85


def revised(
    front: Front, panels: Sequence[FrontPanel], found: Sequence[Rectangle]
) -> list[FrontPanel]:
    """Panels as the network sees them where it is sure, and those that it alone sees beside them.

    Args:
        front: the side.
        panels: that were found there; their values are log-odds.
        found: rectangles that are closed by seams.
    """
    glimpses = glimpsed(front)
    others = [
        group.panels[0] for group in rated(front.scene, found) if group.rectangle.closed >= CLOSED
    ]
    kept = _exchanged(front, _recut(panels, glimpses), [*glimpses, *others])
    return [*kept, *_clear(glimpses, kept)]


def _recut(panels: Sequence[FrontPanel], glimpses: Sequence[FrontPanel]) -> list[FrontPanel]:
    """Cut where the network sees ends instead of half-way between handles."""
    cut = [panel for panel in panels if panel.cut]
    kept = [panel for panel in panels if not panel.cut]
    own = [each for each in _clear(glimpses, kept) if not _clear([each], cut)]
    held = all(any(each.rectangle.holds(panel.handles[0].center) for each in own) for panel in cut)
    enough = _area(own) >= MOST_OF * _area(cut)
    return [*kept, *own] if held and enough and len(own) >= FEWEST else list(panels)


def _exchanged(
    front: Front, panels: Sequence[FrontPanel], others: Sequence[FrontPanel]
) -> list[FrontPanel]:
    """With rectangles around the same handle for those that the network doubts."""
    kept = list(panels)
    for index, panel in enumerate(panels):
        if front.sight.shows(panel.rectangle) >= DOUBTED:
            continue
        rest = [*kept[:index], *kept[index + 1 :]]
        fit = [
            each.rectangle
            for each in _clear(others, rest)
            if panel.handle in each.handles
            and front.sight.shows(each.rectangle) >= SURE
            and in_common(panel.rectangle, each.rectangle) < OTHER
        ]
        if fit:
            kept[index] = replace(panel, rectangle=max(fit, key=lambda each: each.area))
    return kept


def _area(panels: Sequence[FrontPanel]) -> float:
    return sum(panel.rectangle.area for panel in panels)


def _clear(panels: Sequence[FrontPanel], others: Sequence[FrontPanel]) -> list[FrontPanel]:
    """Those that overlap none of the others."""
    return [
        each for each in panels if all(apart(each.rectangle, other.rectangle) for other in others)
    ]
