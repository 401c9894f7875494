"""Round knobs on the fixed front of an appliance."""

from __future__ import annotations

import numpy as np

from ...mesh import BoolArray, FloatArray, IntArray
from ...part import PartKind
from ..proposal import Motion
from .movers import Mover
from .scene import FRONT, RECT, SIDEWAYS, Scene

LARGEST = 0.15
"""Of the front's shorter side."""
SECTORS = 12
BUTTONS = 8


def find_top_knobs(above: Scene, taken: IntArray) -> tuple[Mover, ...]:
    """Find knobs of a cooktop, seen from above: three or more squat equal ones in a row."""
    knobs = find_knobs(above, taken)
    if len(knobs) < 3:
        return ()
    places = np.array([m.motion.origin[RECT] for m in knobs])
    places = places - places.mean(axis=0)
    spread = np.linalg.svd(places, compute_uv=False)
    return knobs if spread[1] <= 0.1 * spread[0] else ()


def find_knobs(scene: Scene, taken: IntArray) -> tuple[Mover, ...]:
    """Find knobs among the pieces not ``taken``: equal ones on a plate, or one among buttons.

    Positive turns clockwise as seen from the front. Knobs turn without end: their stops cannot be
        seen.
    """
    width, depth, height = scene.extents.T
    free = scene.without(taken)
    small = free & (np.maximum(width, height) <= LARGEST * scene.size[RECT].min())
    sized = small & scene.square(RECT) & (width >= 1.5 * scene.touch)
    stacks: dict[int, IntArray] = {}
    inner: set[int] = set()
    for k in sorted(np.flatnonzero(sized).tolist(), key=lambda k: (-float(depth[k]), k)):
        stack = _stack(scene, k, free)
        proud = float(scene.high[k, FRONT] - scene.low[stack, FRONT].min()) >= 0.25 * width[k]
        if k not in inner and proud and is_round(scene, k):
            stacks[k] = stack
            inner |= {int(piece) for piece in stack}
    round_ones = sorted(stacks)
    plates = {k: _plate(scene, k, stacks[k]) for k in round_ones}
    knobs = [k for k in round_ones if plates[k] >= 0 and _has_company(scene, k, plates, small)]
    knobs.sort(key=lambda k: scene.reading_place(scene.low[k], scene.high[k]))
    axis = np.eye(3)[FRONT]
    guess = ("is round and turns without end; its stops are unknown",)
    return tuple(
        Mover(PartKind.KNOB, Motion.endless(axis, scene.middle[k]), stacks[k], guess) for k in knobs
    )


def is_round(scene: Scene, piece: int) -> bool:
    """Tell whether a piece's outline is a circle: corners near the rim in all directions."""
    corners = scene.triangles[scene.labels == piece].reshape(-1, 3)[:, RECT]
    center = scene.middle[piece, RECT]
    radius = float(scene.extents[piece, SIDEWAYS]) / 2.0
    return goes_round(corners - center, 0.93 * radius, 1.04 * radius)


def goes_round(offsets: FloatArray, inner: float, outer: float) -> bool:
    """Tell whether points are within a circle, and near it in all directions.

    Args:
        offsets: of the points from its middle [m], shape [n, 2].
        inner: radius from which a point is near the circle [m].
        outer: radius that no point is beyond [m].
    """
    distance = np.linalg.norm(offsets, axis=1)
    rim = offsets[distance >= inner]
    sectors = np.floor(np.arctan2(rim[:, 1], rim[:, 0]) / (2.0 * np.pi) * SECTORS)
    directions = np.unique(sectors.astype(np.int64) % SECTORS)
    return bool(distance.max() <= outer and len(directions) == SECTORS)


def _plate(scene: Scene, piece: int, stack: IntArray) -> int:
    """Return the piece that a knob sits on with its stack; -1 if hidden or on nothing."""
    start = scene.middle[piece].copy()
    start[RECT] += 0.2 * scene.extents[piece][RECT]
    start[FRONT] = scene.box[0, FRONT] - scene.touch
    small = np.flatnonzero((scene.extents[:, RECT] < scene.extents[piece, RECT]).all(axis=1))
    _, first = scene.first_hit(start, FRONT, 1, small[small != piece])
    start[FRONT] = scene.high[piece, FRONT] - 0.1 * scene.extents[piece, FRONT]
    distance, plate = scene.first_hit(start, FRONT, 1, stack)
    sits = distance <= scene.touch + 0.1 * scene.extents[piece, FRONT]
    return plate if first in stack and sits else -1


def _has_company(scene: Scene, knob: int, plates: dict[int, int], small: IntArray) -> bool:
    size = scene.extents[knob, SIDEWAYS]
    same_plate = [k for k, plate in plates.items() if plate == plates[knob]]
    twins = sum(bool(abs(scene.extents[k, SIDEWAYS] - size) <= 0.05 * size) for k in same_plate)
    plate = plates[knob]
    close = scene.within(scene.low[plate] - scene.touch, scene.high[plate] + scene.touch, RECT)
    front = np.abs(scene.high[:, FRONT] - scene.high[knob, FRONT]) <= 2.0 * scene.touch
    return twins > 1 or int((small & close & front).sum()) > BUTTONS


def _stack(scene: Scene, knob: int, free: BoolArray) -> IntArray:
    """Return the knob and the pieces mounted on it, within its outline."""
    slack = 0.02 * scene.extents[knob]
    inside = (
        scene.within(scene.low[knob] - slack, scene.high[knob] + slack, RECT)
        & free
        & (scene.low[:, FRONT] < scene.high[knob, FRONT])
        & (scene.high[:, FRONT] <= scene.high[knob, FRONT] + scene.touch)
    )
    return np.union1d(np.flatnonzero(inside), [knob])
