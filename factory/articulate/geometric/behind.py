"""The space behind a front panel: a drawer's box, a cavity, or nothing to open."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...mesh import FloatArray, IntArray
from .panels import is_open_box
from .scene import FRONT, RECT, SIDEWAYS, UP, Scene
from .slab import FrontSlab, overlap_area

DEEP = 0.25
"""A drawer's box reaches at least this share of the object's depth behind its panel."""


@dataclass(frozen=True, eq=False)
class FrontFace:
    """A panel that may move, and the space behind it.

    Attributes:
        panel: the slab in the front.
        pieces: all that move with it: its own, a drawer's box, or else pieces that touch only the
            panel, e.g. racks in a fridge door.
        has_box: whether a drawer's box is behind it.
        depth: free depth behind the panel, or the box's [m].
        walls: how many of the five sides (left, right, below, above, back) a cavity has.
        solid: whether something is right behind the panel over most of it.
        roomy: whether the space is about as wide as the panel, not just the inside of some post.
    """

    panel: FrontSlab
    pieces: IntArray
    has_box: bool
    depth: float
    walls: int
    solid: bool
    roomy: bool = True


def look_behind(scene: Scene, panel: FrontSlab, panels: tuple[FrontSlab, ...]) -> FrontFace:
    """Find everything that :class:`FrontFace` says, for one panel among all."""
    if panel.is_box:
        depth = float(scene.extents[panel.slabs[0], FRONT])
        middle = scene.middle[panel.slabs[0]]
        back = scene.distances(middle, [(FRONT, 1)], panel.pieces)
        walls = int(np.isfinite([*_around(scene, middle, panel.pieces), *back]).sum())
        return FrontFace(panel, panel.pieces, True, depth, walls, False)
    box = np.zeros(0, dtype=np.int64)
    if not panel.has_side_handle:
        box = _drawer_box(scene, panel, panels)
    depth, walls, solid, roomy = _cavity(scene, panel, box)
    if len(box):
        depth = max(float(scene.high[box, FRONT].max() - panel.high[FRONT]), 0.0)
    pieces = np.union1d(panel.pieces, box if len(box) else _attached(scene, panel, panels))
    return FrontFace(panel, pieces, bool(len(box)), depth, walls, solid, roomy)


def _behind(
    scene: Scene, panel: FrontSlab, panels: tuple[FrontSlab, ...], slack: float
) -> IntArray:
    """Return the pieces behind the panel, inside its rectangle, and no other panel's."""
    margin = slack * (panel.high - panel.low)
    inside = scene.within(panel.low - margin, panel.high + margin, RECT)
    inside &= scene.low[:, FRONT] >= panel.low[FRONT] - scene.touch
    inside &= scene.high[:, FRONT] > panel.high[FRONT] + scene.touch
    for other in panels:
        inside[other.pieces] = False
        if other is panel or abs(other.low[FRONT] - panel.low[FRONT]) > 0.2 * scene.size[FRONT]:
            continue
        margin = slack * (other.high - other.low)
        inside &= ~scene.within(other.low - margin, other.high + margin, RECT)
    return np.flatnonzero(inside)


def _drawer_box(scene: Scene, panel: FrontSlab, panels: tuple[FrontSlab, ...]) -> IntArray:
    """Return two sides and a bottom, or one body, behind the panel; else nothing."""
    index = _behind(scene, panel, panels, 0.02)
    edge = 0.004 * scene.size
    outermost = (scene.low[index, SIDEWAYS] <= scene.box[0, SIDEWAYS] + edge[SIDEWAYS]) | (
        scene.high[index, SIDEWAYS] >= scene.box[1, SIDEWAYS] - edge[SIDEWAYS]
    )
    outermost |= scene.high[index, UP] >= scene.box[1, UP] - edge[UP]
    index = index[~outermost]
    width, depth, height = scene.extents[index].T
    center = scene.middle[index]
    close = scene.low[index, FRONT] <= panel.high[FRONT] + 0.1 * scene.size[FRONT]
    deep = (depth >= DEEP * scene.size[FRONT]) & close
    side = deep & (width <= 0.15 * panel.width) & (height >= 0.2 * panel.height)
    left = side & (center[:, SIDEWAYS] < panel.center[SIDEWAYS] - 0.25 * panel.width)
    right = side & (center[:, SIDEWAYS] > panel.center[SIDEWAYS] + 0.25 * panel.width)
    bottom = deep & (height <= 0.25 * panel.height) & (width >= 0.5 * panel.width)
    bottom &= center[:, UP] < panel.center[UP]
    body = deep & (width >= 0.6 * panel.width) & (height >= 0.3 * panel.height)
    body &= np.array(
        [b and is_open_box(scene, int(i)) for i, b in zip(index, body, strict=True)], dtype=bool
    )
    if body.any() or (left.any() and right.any() and bottom.any()):
        return scene.linked_to(index, body | left | right | bottom)
    return np.zeros(0, dtype=np.int64)


def _cavity(scene: Scene, panel: FrontSlab, box: IntArray) -> tuple[float, int, bool, bool]:
    """Return the depth, walls, solid and roomy of :class:`FrontFace`."""
    ignored = np.union1d(panel.pieces, box)
    start = panel.high[FRONT] + scene.touch / 8.0
    free = [
        scene.first_hit(panel.point(u, start, v), FRONT, 1, ignored)[0]
        for u in ACROSS
        for v in UPWARDS
    ]
    depth = float(np.median(free))
    walls = int(np.isfinite(depth))
    if not np.isfinite(depth):
        depth = float(scene.box[1, FRONT] - start)
    inner = panel.high[FRONT] + min(0.5 * depth, 0.3 * float(scene.size[FRONT]))
    sides = 0
    roomy = False
    for u, v in INSIDE:
        distances = _around(scene, panel.point(u, inner, v), ignored)
        wide = bool(
            distances[:2].sum() >= 0.5 * panel.width and distances[2:].sum() >= 0.1 * panel.height
        )
        sides, roomy = max((sides, roomy), (int(np.isfinite(distances).sum()), wide))
    return depth, walls + sides, depth <= max(scene.touch, 0.1 * float(scene.size[FRONT])), roomy


ACROSS = (0.21, 0.47, 0.78)
UPWARDS = (0.13, 0.29, 0.46, 0.63, 0.86)
INSIDE = ((0.5, 0.5), (0.45, 0.36), (0.55, 0.66))
"""Uneven, so that evenly spaced shelves do not meet all rays."""


def _around(scene: Scene, start: FloatArray, ignored: IntArray) -> FloatArray:
    """Measure to the left, right, below and above [m], shape [4]; infinite where nothing is."""
    return scene.distances(start, [(axis, sign) for axis in RECT for sign in (-1, 1)], ignored)


def _attached(scene: Scene, panel: FrontSlab, panels: tuple[FrontSlab, ...]) -> IntArray:
    """Return the shallow pieces behind the panel that touch it and nothing that stays."""
    index = _behind(scene, panel, panels, 0.0)
    shallow = scene.high[index, FRONT] - panel.high[FRONT] <= 0.3 * scene.size[FRONT]
    index = index[shallow]
    hair = scene.touch / 2
    group = scene.linked_to(index, scene.meeting(panel.low - hair, panel.high + hair)[index])
    if not len(group):
        return group
    near = scene.meeting(*scene.box_of(group)) & scene.without(np.union1d(group, panel.pieces))
    # More than trim: over 2 % of the front in any two directions.
    sides = np.sort(scene.extents[near], axis=1)[:, 1:]
    bulky = (np.prod(sides, axis=1) > 0.02 * scene.front_area).any()
    return np.zeros(0, dtype=np.int64) if bulky else group


def covers(low: FrontSlab, high: FrontSlab) -> float:
    """Return the share of the smaller panel's rectangle that the two have in common."""
    shared = overlap_area(low.low, low.high, high.low, high.high)
    return float(shared) / max(min(low.area, high.area), 1e-12)
