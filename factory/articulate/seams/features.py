"""Features of a rectangle that may be a panel, in figures that do not depend on size."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...mesh import FloatArray
from .candidates import FrontScene, main_pulls
from .handles import GripShape, Protrusion
from .rectangles import Lines, Rectangle
from .relief import Relief

#: A ring of that width around a rectangle is what it is compared with [pixels].
RING = 5
#: Two panels are aligned if their lines differ by no more than this [pixels].
ALIGNED = 6.0
#: So near to a side, as a share of the size, lies its own bevel and no other seam.
BEVEL = 0.025
#: Heights beyond are as good as this one [pixels].
HIGH = 12.0

NAMES = (
    *(f"cover_{index}" for index in range(4)),
    *(f"relief_{index}" for index in range(4)),
    *("area", "aspect", "rows", "columns", "below", "above", "left", "right"),
    *("pulls", "two_pulls", "more_pulls", "stands_off", "grip_rows", "grip_columns"),
    *("grip_aside", "grip_up", "grip_fill", "carries", "controls", "all_pulls"),
    *("level_inside", "upright_inside", "levels", "uprights", "outlines"),
    *("thick_short", "thick_long", "span", "proud_least", "proud", "uneven", "contrast"),
    *("like_beside", "like_stacked", "cut", "width", "depth", "filled", "all_controls"),
)


@dataclass(frozen=True, eq=False)
class Context:
    """What the rectangles of one side are compared with.

    Attributes:
        scene: the side.
        others: every rectangle that may be a panel.
    """

    scene: FrontScene
    others: Sequence[Rectangle]


def features(around: Context, rectangle: Rectangle, *, cut: bool) -> FloatArray:
    """Return the figures about one rectangle, as :data:`NAMES` has them, shape [feature_count].

    Args:
        around: its side.
        rectangle: that may be a panel.
        cut: it ends half-way between two handles.
    """
    scene = around.scene
    handles = scene.handles_in(rectangle)
    return np.array(
        [
            *np.sort(rectangle.sides),
            *np.sort(rectangle.relief),
            *_place(scene.relief, rectangle),
            *_grips(scene, rectangle, handles),
            *_inside(scene, rectangle),
            *_surface(scene, rectangle),
            *_alike(rectangle, around.others),
            float(cut),
            *_whole(scene),
        ]
    )


def _place(relief: Relief, rectangle: Rectangle) -> list[float]:
    """Return the size, shape and place on the side, in shares of the visible side."""
    first_row, last_row, first_column, last_column = relief.box
    low = np.array([first_row, first_column])
    size = np.maximum(np.array([last_row, last_column]) - low, 1)
    start = (rectangle.low - low) / size
    stop = (low + size - rectangle.high) / size
    rows, columns = np.maximum(rectangle.size, 1)
    return [
        float(np.log(max(rectangle.area, 1.0) / max(int(relief.seen.sum()), 1))),
        float(np.log(columns / rows)),
        *(rectangle.size / size),
        start[0],
        stop[0],
        start[1],
        stop[1],
    ]


def _grips(scene: FrontScene, rectangle: Rectangle, handles: Sequence[Protrusion]) -> list[float]:
    controls = [handle for handle in scene.face.handles if handle.control]
    inside = sum(rectangle.holds(handle.center) for handle in controls)
    every = min(len(scene.face.pulls), 8) / 8.0
    if not handles:
        return [*(0.0,) * 10, min(inside, 4) / 4.0, every]
    pulls = len(main_pulls(handles, rectangle))
    main = handles[0]
    up, across = (main.center - rectangle.low) / np.maximum(rectangle.size, 1)
    return [
        1.0,
        float(pulls == 2),
        float(pulls > 2),
        min(main.height, HIGH) / HIGH,
        *np.minimum(main.size / np.maximum(rectangle.size, 1), 1.0),
        2.0 * abs(across - 0.5),
        up,
        main.fill,
        float(main.carries),
        min(inside, 4) / 4.0,
        every,
    ]


def _inside(scene: FrontScene, rectangle: Rectangle) -> list[float]:
    """Return the lines that run through it, and how many of its sides are the outline's."""
    level = crossing(scene.level, rectangle, 1, 0)
    upright = crossing(scene.upright, rectangle, 0, 1)
    return [
        float(level.max(initial=0.0)),
        float(upright.max(initial=0.0)),
        min(float((level > 0.8).sum()), 4.0) / 4.0,
        min(float((upright > 0.8).sum()), 4.0) / 4.0,
        outline_sides(scene.relief, rectangle) / 4.0,
    ]


def crossing(lines: Lines, rectangle: Rectangle, along: int, across: int) -> FloatArray:
    """Return the cover of every line that runs through a rectangle from side to side."""
    margin = max(BEVEL * float(rectangle.size[across]), 6.0)
    between = np.flatnonzero(
        (lines.at > rectangle.low[across] + margin) & (lines.at < rectangle.high[across] - margin)
    )
    return lines.in_relief(between, rectangle.low[along], rectangle.high[along])


def outline_sides(relief: Relief, rectangle: Rectangle) -> int:
    """Return how many of a rectangle's sides are the side's own outline."""
    box = relief.box
    ends = (
        rectangle.low[0] - box[0],
        box[1] - rectangle.high[0],
        rectangle.low[1] - box[2],
        box[3] - rectangle.high[1],
    )
    return int(sum(end <= 0.015 * max(relief.shape) for end in ends))


def _surface(scene: FrontScene, rectangle: Rectangle) -> list[float]:
    """Return how thick, how proud and how even it is, and how unlike its surroundings in colour."""
    relief = scene.relief
    rows, columns = (
        slice(int(low) + 2, max(int(high) - 1, int(low) + 3))
        for low, high in zip(rectangle.low, rectangle.high, strict=True)
    )
    height = scene.face.height[rows, columns]
    behind = float(np.median(scene.thickness[rows, columns]))
    short = max(float(rectangle.size.min()), 1.0)
    long = max(float(rectangle.size.max()), 1.0)
    front = float(np.median(height))
    color = np.median(relief.lab[rows, columns].reshape(-1, 3), axis=0)
    proud: list[float] = []
    other: list[float] = []
    for strip in _ring(rectangle, relief.shape):
        here = scene.face.height[strip]
        proud.append(float(np.median(front - here)) if here.size else HIGH)
        if here.size:
            beside = np.median(relief.lab[strip].reshape(-1, 3), axis=0)
            other.append(float(np.linalg.norm(beside - color)))
    away = np.clip(proud, -HIGH, HIGH) / HIGH
    box = relief.box
    span = relief.seen[rows].sum(axis=1).mean() / max(box[3] - box[2], 1)
    uneven = float(np.subtract(*np.percentile(height, [90, 10])))
    return [
        min(behind / short, 2.0),
        min(behind / long, 2.0),
        float(span),
        float(away.min()),
        float(away.mean()),
        min(uneven, HIGH) / HIGH,
        min(float(np.median(other)) if other else 0.0, 40.0) / 40.0,
    ]


def _ring(rectangle: Rectangle, shape: tuple[int, int]) -> list[tuple[slice, slice]]:
    """Return the strips below, above, left and right of a rectangle, a little apart from it."""
    bottom, left = (int(value) for value in rectangle.low)
    top, right = (int(value) for value in rectangle.high)
    rows = slice(bottom, top + 1)
    columns = slice(left, right + 1)
    return [
        (slice(max(bottom - 2 - RING, 0), max(bottom - 2, 0)), columns),
        (slice(min(top + 3, shape[0]), top + 3 + RING), columns),
        (rows, slice(max(left - 2 - RING, 0), max(left - 2, 0))),
        (rows, slice(min(right + 3, shape[1]), right + 3 + RING)),
    ]


def _alike(rectangle: Rectangle, others: Sequence[Rectangle]) -> list[float]:
    """Return how many rectangles of the same size lie beside it and above or below it."""
    low = np.array([other.low for other in others]).reshape(-1, 2)
    size = np.array([other.size for other in others]).reshape(-1, 2)
    apart = np.abs(low - rectangle.low)
    differ = np.abs(size - rectangle.size)
    beside = (apart[:, 0] <= ALIGNED) & (differ <= ALIGNED).all(axis=1)
    beside &= apart[:, 1] >= 0.9 * rectangle.size[1]
    stacked = (apart[:, 1] <= ALIGNED) & (differ[:, 1] <= ALIGNED)
    stacked &= (differ[:, 0] <= 0.5 * rectangle.size[0]) & (apart[:, 0] >= 0.6 * rectangle.size[0])
    return [min(float(each.sum()), 4.0) / 4.0 for each in (beside, stacked)]


def _whole(scene: FrontScene) -> list[float]:
    """Return the shape of the side and of the object behind it."""
    relief = scene.relief
    first_row, last_row, first_column, last_column = relief.box
    rows = max(last_row - first_row, 1)
    columns = max(last_column - first_column, 1)
    depth = relief.depth / relief.raster.pixel
    controls = sum(handle.control for handle in scene.face.handles)
    return [
        float(np.log(columns / rows)),
        float(np.log(max(depth, 1.0) / rows)),
        float(relief.seen.sum()) / (rows * columns),
        min(controls, 6) / 6.0,
    ]


def motion_features(
    scene: FrontScene, rectangle: Rectangle, panels: Sequence[Rectangle]
) -> FloatArray:
    """Return what tells how a panel opens, as :data:`MOTION_NAMES` has it, shape [feature_count].

    Args:
        scene: the side.
        rectangle: the panel.
        panels: all that are there.
    """
    handles = scene.handles_in(rectangle)
    place = _place(scene.relief, rectangle)
    return np.array(
        [
            *place,
            *_grip(rectangle, handles),
            *_neighbours(scene, rectangle, panels),
            *_whole(scene),
        ]
    )


MOTION_NAMES = (
    *("area", "aspect", "rows", "columns", "below", "above", "left", "right"),
    *("pull", "across", "aside", "up", "top", "foot", "grip_rows", "grip_columns"),
    *("upright", "level", "knob", "mates", "upright_across"),
    *("like_beside", "like_stacked", "beside_left", "beside_right"),
    *("their_side_left", "their_side_right"),
    *("width", "depth", "filled", "controls"),
)


def _grip(rectangle: Rectangle, handles: Sequence[Protrusion]) -> list[float]:
    if not handles:
        return [0.0] * 13
    main = handles[0]
    up, across = (main.center - rectangle.low) / np.maximum(rectangle.size, 1)
    mates = [
        other
        for other in handles[1:]
        if other.height >= 0.5 * main.height and abs(other.center[0] - main.center[0]) <= ALIGNED
    ]
    for mate in mates:
        # Two handles of one drawer pull in its middle.
        middle = (main.center[1] + mate.center[1]) / 2.0
        across = (middle - rectangle.low[1]) / max(float(rectangle.size[1]), 1.0)
    grip = main.grip
    return [
        1.0,
        2.0 * across - 1.0,
        2.0 * abs(across - 0.5),
        up,
        max(up - 0.7, 0.0),
        max(0.3 - up, 0.0),
        *np.minimum(main.size / np.maximum(rectangle.size, 1), 1.0),
        float(grip is GripShape.UPRIGHT),
        float(grip is GripShape.LEVEL),
        float(grip is GripShape.KNOB),
        float(bool(mates)),
        (2.0 * across - 1.0) * float(grip is GripShape.UPRIGHT),
    ]


def _neighbours(
    scene: FrontScene, rectangle: Rectangle, panels: Sequence[Rectangle]
) -> list[float]:
    """Describe panels like it, beside it, and where those beside it have their handles."""
    others = [other for other in panels if other is not rectangle]
    if not others:
        return [0.0] * 6
    left = right = their_left = their_right = 0.0
    for other in others:
        if abs(other.low[0] - rectangle.low[0]) > ALIGNED:
            continue
        handles = scene.handles_in(other)
        if other.low[1] < rectangle.low[1]:
            left = 1.0
            their_left += _aside(other, handles)
        else:
            right = 1.0
            their_right += _aside(other, handles)
    theirs = np.clip([their_left, their_right], -1.0, 1.0)
    return [*_alike(rectangle, others), left, right, *theirs]


def _aside(rectangle: Rectangle, handles: Sequence[Protrusion]) -> float:
    """Return how far to the right its handle is, -1 to 1; 0 without one."""
    if not handles:
        return 0.0
    across = (handles[0].center[1] - rectangle.low[1]) / max(float(rectangle.size[1]), 1.0)
    return float(2.0 * across - 1.0)
