"""Which rectangles of a front are panels that open."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...views.raster import PIXELS
from .candidates import (
    FLAT,
    MOST_FOUND,
    FrontScene,
    PanelLimits,
    cut_between,
    distinct,
    main_pulls,
    of_one_kind,
    steps_back,
    usable,
    whole_side,
)
from .features import ALIGNED, crossing, outline_sides
from .groups import FrontPanel, Group, clear_of, together
from .handles import GripShape, Protrusion
from .rectangles import Rectangle
from .relief import Relief

#: A rectangle is cut between at most so many handles, and what each piece is then worth.
MOST_PIECES = 9
CUT_VALUE = 1.2
#: What a rectangle must have that the hand score is asked about.
STRICT = PanelLimits(solid=0.9, area=0.015, slimmest=0.15, span=0.5)
#: A seam that crosses a rectangle is covered so far, by the shape alone.
CROSSED = 0.85
#: A handle that stands off so far is certainly one [pixels].
FULL_HEIGHT = 4.0
#: Panels on a front without any handle must be closed and engraved to this.
CLOSED_BARE = 0.82
#: A bar is at most so thick, as a share of the panel across it.
GRIP = 0.6
#: No drawer is so low at the foot of a front (shares of the front's height).
PLINTH = 0.13
#: What a rectangle must be worth.
LEAST_VALUE = 0.8


def choose(scene: FrontScene, found: Sequence[Rectangle]) -> tuple[FrontPanel, ...]:
    """Return the panels of one side that can be there together.

    Args:
        scene: the side.
        found: its closed rectangles, the best first.
    """
    level, others = _groups(scene, found)
    every = (*level, *others)
    cuts = [cut for each in every if (cut := _divided(scene, each.rectangle)) is not None]
    kept = [*level, *cuts]
    pulled = [group for group in kept if group.panels[0].handles and group.value >= LEAST_VALUE]
    pulled.sort(key=lambda group: -group.value)
    chosen = [panel for group in together(pulled) for panel in group.panels]
    bare = [group for group in kept if not group.panels[0].handles]
    return (*chosen, *_without_handles(scene.relief, chosen, bare))


def _groups(scene: FrontScene, found: Sequence[Rectangle]) -> tuple[list[Group], list[Group]]:
    """Return what may be panels, and what steps back and may only be cut into some."""
    first_row, last_row, _, _ = scene.relief.box
    if last_row - first_row < FLAT * PIXELS:
        return [], []
    solid = usable(scene, (*found[:MOST_FOUND], whole_side(scene)), STRICT)
    groups = [
        Group(each, (FrontPanel(each, scene.handles_in(each), _value(scene, each)),))
        for each in solid
    ]
    back = steps_back(scene, solid)
    order = sorted(range(len(groups)), key=lambda index: (back[index], -groups[index].value))
    kept = distinct(scene, solid, order)
    level = [groups[index] for index in kept if not back[index]]
    return level, [groups[index] for index in kept if back[index]]


def _divided(scene: FrontScene, rectangle: Rectangle) -> Group | None:
    """Return a rectangle with several pulls, cut between them."""
    pulls = main_pulls(scene.handles_in(rectangle), rectangle)
    if not pulls or not of_one_kind(pulls) or _crossings(scene, rectangle) > len(pulls):
        return None
    pieces = cut_between(scene, rectangle, pulls, MOST_PIECES)
    if not pieces:
        return None
    value = CUT_VALUE + 2.0 * (rectangle.closed - 0.75)
    panels = tuple(FrontPanel(piece, (handle,), value, cut=True) for piece, handle in pieces)
    return Group(rectangle, panels)


def _value(scene: FrontScene, rectangle: Rectangle) -> float:
    """Return what speaks for a rectangle; the terms are in halves, set by hand."""
    relief = scene.relief
    face = scene.face
    handles = scene.handles_in(rectangle)
    pulls = len(main_pulls(handles, rectangle))
    value = 4.0 * (rectangle.closed - 0.75) + 1.0 * float(rectangle.relief.mean())
    value += 0.25 * float(np.log(rectangle.area / relief.seen.sum()))
    controls = sum(rectangle.holds(handle.center) for handle in face.handles if handle.control)
    if pulls:
        value += 2.0 * _certainty(handles[0]) - 1.5 * (pulls - 1)
        across = int(handles[0].grip is GripShape.UPRIGHT)
        value -= 2.0 * bool(handles[0].size[across] > GRIP * rectangle.size[across])
    if controls >= 3 and pulls == 0:
        value -= 3.0
    elif controls >= 3:
        value -= 1.0
    value -= min(_crossings(scene, rectangle), 2)
    outlines = outline_sides(relief, rectangle)
    if outlines == 4:
        value -= 1.5
    if outlines >= 2 and handles and handles[0].carries:
        value -= 2.0
    return value


def _certainty(handle: Protrusion) -> float:
    """Return how surely a blob is a handle, by how far it stands off."""
    return float(np.clip((handle.height - 1.0) / FULL_HEIGHT, 0.3, 1.0))


def _crossings(scene: FrontScene, rectangle: Rectangle) -> int:
    """Return how many seams run through a rectangle from side to side: then it is not one panel."""
    level = crossing(scene.level, rectangle, 1, 0)
    upright = crossing(scene.upright, rectangle, 0, 1)
    return int((level >= CROSSED).sum() + (upright >= CROSSED).sum())


def _without_handles(
    relief: Relief, pulled: Sequence[FrontPanel], bare: Sequence[Group]
) -> list[FrontPanel]:
    """Return the panels without a handle beside one that has one and is like them."""
    free = [
        group
        for group in clear_of(bare, pulled)
        if any(_alike(group.rectangle, other.rectangle) for other in pulled)
        and _engraved(group.rectangle)
        and not _plinth(relief, group.rectangle)
    ]
    return [panel for group in together(free) for panel in group.panels]


def _engraved(rectangle: Rectangle) -> bool:
    return rectangle.closed >= CLOSED_BARE and float(np.sort(rectangle.relief)[1]) >= 0.6


def _plinth(relief: Relief, rectangle: Rectangle) -> bool:
    box = relief.box
    height = max(box[1] - box[0], 1)
    at_foot = rectangle.low[0] - box[0] <= 0.03 * height
    return bool(at_foot and rectangle.size[0] <= PLINTH * height)


def _alike(one: Rectangle, other: Rectangle) -> bool:
    """Return whether two panels are a row or a column of the same size."""
    low = np.abs(one.low - other.low)
    high = np.abs(one.high - other.high)
    size = np.abs(one.size - other.size) / np.maximum(other.size, 1)
    beside = low[0] <= ALIGNED and high[0] <= ALIGNED and size[1] <= 0.15
    stacked = low[1] <= ALIGNED and high[1] <= ALIGNED and size[0] <= 0.5
    return bool(beside or stacked)
