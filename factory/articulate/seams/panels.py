"""Which rectangles of a front are panels that open."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...mesh import FloatArray
from .handles import Face, Handle
from .rectangles import Lines, Rectangle
from .relief import Relief

#: Rectangles with so much in common (intersection over union) are one.
SAME = 0.8
#: Two panels may share this much of the smaller one.
OVERLAP = 0.08
#: Rectangles looked at, best first.
MOST = 60
#: Of a rectangle so much must be seen and face the viewer.
SOLID = 0.9
#: And so much of the picture's area it covers.
LEAST_AREA = 0.015
#: What opens is a container: so thick as a share of the panel's shorter and longer side.
THICK_SHORT = 0.15
THICK_LONG = 0.08
#: The object is there so wide as a share of its whole width: no tank on a bowl.
LEAST_SPAN = 0.5
#: A seam that crosses a rectangle is covered so far, by the shape alone.
CROSSED = 0.85
#: A handle belongs to a panel if its centre is that far inside [pixels].
INSIDE = 1.0
#: Panels on a front without any handle must be closed and engraved to this.
CLOSED_BARE = 0.82
#: Two panels are aligned if their lines differ by no more than this [pixels].
ALIGNED = 6.0
#: No drawer is so low at the foot of a front (shares of the front's height).
PLINTH = 0.13
#: What a rectangle must be worth.
LEAST_VALUE = 0.8


@dataclass(frozen=True, eq=False)
class Panel:
    """A rectangle that opens.

    Attributes:
        rectangle: where it is.
        handles: its pulls, the most prominent first.
        value: what speaks for it: grows with evidence, no probability.
        cut: its border is half-way between handles; nobody saw a seam there.
    """

    rectangle: Rectangle
    handles: tuple[Handle, ...]
    value: float
    cut: bool = False

    @property
    def handle(self) -> Handle | None:
        """The one that it is pulled by."""
        return self.handles[0] if self.handles else None

    @property
    def aspect(self) -> float:
        """Width over height."""
        return float(self.rectangle.size[1] / max(self.rectangle.size[0], 1))


@dataclass(frozen=True, eq=False)
class Scene:
    """One side, ready to be searched for panels.

    Attributes:
        relief: the side.
        face: it without handles.
        thickness: how much lies behind each pixel [pixels], shape [rows, columns].
        level, upright: candidate lines.
    """

    relief: Relief
    face: Face
    thickness: FloatArray
    level: Lines
    upright: Lines


def choose(scene: Scene, found: Sequence[Rectangle]) -> tuple[Panel, ...]:
    """The panels of one side that can be there together.

    Args:
        scene: the side.
        found: its closed rectangles, the best first.
    """
    relief = scene.relief
    face = scene.face
    rated = [
        Panel(each, _inside(each, face), _value(scene, each)) for each in _usable(scene, found)
    ]
    rated.sort(key=lambda panel: -panel.value)
    kept: list[Panel] = []
    for panel in rated:
        if all(_in_common(panel.rectangle, other.rectangle) < SAME for other in kept):
            kept.append(panel)
        if len(kept) >= MOST:
            break
    pulled = _together([panel for panel in kept if panel.handles and panel.value >= LEAST_VALUE])
    bare = [panel for panel in kept if not panel.handles]
    return (*pulled, *_without_handles(relief, pulled, bare))


def _usable(scene: Scene, found: Sequence[Rectangle]) -> list[Rectangle]:
    """Those that are solid, face the viewer, and have something behind them that could be open."""
    relief = scene.relief
    box = relief.box
    whole = max((box[1] - box[0]) * (box[3] - box[2]), 1)
    facing = relief.seen & ((relief.facing > 0.7) | scene.face.covered)
    usable = []
    for each in found:
        inner = tuple(
            slice(int(low) + 2, max(int(high) - 1, int(low) + 3))
            for low, high in zip(each.low, each.high, strict=True)
        )
        short = float(each.size.min())
        long = float(each.size.max())
        thick = float(np.median(scene.thickness[inner]))
        span = float(np.median(relief.seen[inner[0]].sum(axis=1)))
        if (
            each.area >= LEAST_AREA * whole
            and facing[inner].mean() >= SOLID
            and thick >= max(THICK_SHORT * short, THICK_LONG * long)
            and span >= LEAST_SPAN * (box[3] - box[2])
        ):
            usable.append(each)
    return usable


def _inside(rectangle: Rectangle, face: Face) -> tuple[Handle, ...]:
    inside = [h for h in face.pulls if rectangle.holds(h.center, INSIDE) and _smaller(h, rectangle)]
    return tuple(sorted(inside, key=lambda h: -h.height * float(np.sqrt(h.size.prod()))))


def _smaller(handle: Handle, rectangle: Rectangle) -> bool:
    return bool((handle.size <= 1.02 * rectangle.size).all())


def _value(scene: Scene, rectangle: Rectangle) -> float:
    """What speaks for a rectangle; the terms are in halves, set by hand."""
    relief = scene.relief
    face = scene.face
    handles = _inside(rectangle, face)
    pulls = pull_count(handles, rectangle)
    value = 4.0 * (rectangle.closed - 0.75) + 1.0 * float(rectangle.relief.mean())
    value += 0.25 * float(np.log(rectangle.area / relief.seen.sum()))
    controls = sum(
        rectangle.holds(handle.center) for handle in face.handles if handle.control
    )
    if pulls == 1:
        value += 2.0
    elif pulls > 1:
        value += 2.0 - 1.5 * (pulls - 1)
    if controls >= 3 and pulls == 0:
        value -= 3.0
    elif controls >= 3:
        value -= 1.0
    value -= min(_crossings(scene, rectangle), 2)
    if outline_sides(relief, rectangle) == 4:
        value -= 1.5
    return value


def _crossings(scene: Scene, rectangle: Rectangle) -> int:
    """How many seams run through a rectangle from side to side: then it is not one panel."""
    count = 0
    for lines, along, across in ((scene.level, 1, 0), (scene.upright, 0, 1)):
        margin = max(0.06 * float(rectangle.size[across]), 5.0)
        between = np.flatnonzero(
            (lines.at > rectangle.low[across] + margin)
            & (lines.at < rectangle.high[across] - margin)
        )
        cover = lines.in_relief(between, rectangle.low[along], rectangle.high[along])
        count += int((cover >= CROSSED).sum())
    return count


def pull_count(handles: Sequence[Handle], rectangle: Rectangle) -> int:
    """How many panels these handles speak for: two alike side by side open one wide drawer."""
    if not handles:
        return 0
    main = handles[0]
    others = [h for h in handles[1:] if h.height >= 0.5 * main.height]
    middle = (rectangle.low + rectangle.high) / 2.0
    count = 1
    for other in others:
        level = abs(other.center[0] - main.center[0]) <= 0.1 * rectangle.size[0]
        mirrored = (
            abs((other.center[1] + main.center[1]) / 2.0 - middle[1]) <= 0.06 * rectangle.size[1]
        )
        apart = abs(other.center[1] - main.center[1]) >= 0.3 * rectangle.size[1]
        small = other.size.prod() <= 0.35 * main.size.prod()
        if not (level and mirrored and apart) and not small:
            count += 1
    return count


def outline_sides(relief: Relief, rectangle: Rectangle) -> int:
    """How many of a rectangle's sides are the side's own outline."""
    box = relief.box
    ends = (
        rectangle.low[0] - box[0],
        box[1] - rectangle.high[0],
        rectangle.low[1] - box[2],
        box[3] - rectangle.high[1],
    )
    return int(sum(end <= 0.015 * max(relief.shape) for end in ends))


def _in_common(one: Rectangle, other: Rectangle) -> float:
    shared = one.shared(other)
    return shared / (one.area + other.area - shared)


def _apart(one: Rectangle, other: Rectangle) -> bool:
    return one.shared(other) <= OVERLAP * min(one.area, other.area)


def _together(panels: Sequence[Panel]) -> list[Panel]:
    """The set without overlaps that is worth most: greedy, then exchanges that gain."""
    chosen: list[Panel] = []
    for _ in range(3):
        changed = False
        for panel in panels:
            if panel in chosen:
                continue
            against = [p for p in chosen if not _apart(panel.rectangle, p.rectangle)]
            if panel.value > sum(p.value for p in against) + 1e-9:
                chosen = [p for p in chosen if p not in against] + [panel]
                changed = True
        if not changed:
            break
    return chosen


def _without_handles(
    relief: Relief, pulled: Sequence[Panel], bare: Sequence[Panel]
) -> list[Panel]:
    """Panels without a handle: beside one that has one and like it; or several that tile."""
    free = [
        panel
        for panel in bare
        if all(_apart(panel.rectangle, other.rectangle) for other in pulled)
        and _engraved(panel.rectangle)
        and not _plinth(relief, panel.rectangle)
    ]
    if pulled:
        return _together(
            [p for p in free if any(_alike(p.rectangle, o.rectangle) for o in pulled)]
        )
    return []


def _engraved(rectangle: Rectangle) -> bool:
    return rectangle.closed >= CLOSED_BARE and float(np.sort(rectangle.relief)[1]) >= 0.6


def _plinth(relief: Relief, rectangle: Rectangle) -> bool:
    box = relief.box
    height = max(box[1] - box[0], 1)
    at_foot = rectangle.low[0] - box[0] <= 0.03 * height
    return bool(at_foot and rectangle.size[0] <= PLINTH * height)


def _alike(one: Rectangle, other: Rectangle) -> bool:
    """Whether two panels are a row or a column of the same size."""
    low = np.abs(one.low - other.low)
    high = np.abs(one.high - other.high)
    size = np.abs(one.size - other.size) / np.maximum(other.size, 1)
    beside = low[0] <= ALIGNED and high[0] <= ALIGNED and size[1] <= 0.15
    stacked = low[1] <= ALIGNED and high[1] <= ALIGNED and size[0] <= 0.5
    return bool(beside or stacked)
