"""Doors of rooms and casement windows: a slab within a frame, nothing behind it."""

from __future__ import annotations

import numpy as np

from ...articulation import JointKind
from ...mesh import BoolArray, FloatArray, IntArray
from ...part import PartKind
from ..proposal import Motion
from .movers import DOOR_LIMIT, Mover
from .scene import FRONT, RECT, SIDEWAYS, UP, Scene
from .slab import overlap_area

FLAT = 0.3
"""Depth over the shorter side of the front, handles included."""
LEAF = 0.2
"""Share of the front that a leaf covers at least."""
FULL = 0.6
"""Share of its rectangle from which a piece is a leaf; below it is a frame."""


def find_house_doors(scene: Scene) -> tuple[Mover, ...]:
    """Find one leaf or a pair in a frame, if the object is only that."""
    width, _, height = scene.extents.T
    front = scene.front_area
    if scene.size[FRONT] > FLAT * float(scene.size[RECT].min()):
        return ()
    area = width * height
    # Both faces of a slab look along the view, so a full one counts twice.
    full = scene.facing >= 2.0 * FULL * area
    leaves = np.flatnonzero(full & (area >= LEAF * front) & (area <= 0.97 * front))
    leaves = leaves[np.argsort(scene.low[leaves, SIDEWAYS], kind="stable")]
    if not 1 <= len(leaves) <= 2 or (len(leaves) == 2 and not _are_a_pair(scene, leaves)):
        return ()
    groups = [_with_fittings(scene, int(leaf), leaves) for leaf in leaves]
    moving = np.concatenate(groups)
    frame = np.flatnonzero(scene.without(moving))
    if not _is_framed(scene, leaves, frame) or not _opens_to_viewer(scene, leaves, frame):
        return ()
    return tuple(
        _leaf(scene, int(leaf), leaves, group) for leaf, group in zip(leaves, groups, strict=True)
    )


def _are_a_pair(scene: Scene, leaves: IntArray) -> bool:
    a, b = leaves
    gap = float(scene.low[b, SIDEWAYS] - scene.high[a, SIDEWAYS])
    level = float(np.abs(scene.low[a] - scene.low[b])[[FRONT, UP]].sum())
    off = float(np.abs(scene.extents[a] - scene.extents[b]).max())
    same = off <= 0.05 * float(scene.extents[a].max())
    return bool(same and level <= 2.0 * scene.touch and -scene.touch <= gap <= 4.0 * scene.touch)


def _with_fittings(scene: Scene, leaf: int, leaves: IntArray) -> IntArray:
    """Return the leaf and the small pieces on either face of it: handles, panes, bars, trims."""
    inside = (scene.middle >= scene.low[leaf]) & (scene.middle <= scene.high[leaf])
    inside = inside[:, RECT].all(axis=1)
    overhang = np.maximum(scene.low[leaf] - scene.low, scene.high - scene.high[leaf])[:, RECT].max(
        axis=1
    )
    # Generous: a handle's plate may be missing, and nothing else stands before a door.
    near = (scene.low[:, FRONT] <= scene.high[leaf, FRONT] + 4.0 * scene.touch) & (
        scene.high[:, FRONT] >= scene.low[leaf, FRONT] - 4.0 * scene.touch
    )
    fitting = inside & (overhang <= scene.touch) & near
    reach = fitting.copy()
    hair = scene.touch / 2.0
    for k in np.flatnonzero(fitting):
        reach |= inside & scene.meeting(scene.low[k] - hair, scene.high[k] + hair)
    small = scene.extents[:, RECT].max(axis=1) <= 0.6 * float(scene.extents[leaf, RECT].max())
    group = (fitting | (reach & small)) & scene.without(leaves)
    group[leaf] = True
    return np.flatnonzero(group)


def _is_framed(scene: Scene, leaves: IntArray, frame: IntArray) -> bool:
    """Tell whether the frame stands at two opposite sides, with little in front of the leaves."""
    low, high = scene.box_of(leaves)
    hair = scene.touch / 2.0
    for axis, other in ((SIDEWAYS, UP), (UP, SIDEWAYS)):
        long = scene.extents[frame, other] >= 0.8 * (high - low)[other]
        before = long & (scene.low[frame, axis] <= low[axis] + hair)
        after = long & (scene.high[frame, axis] >= high[axis] - hair)
        if before.any() and after.any():
            return not bool(_hides(scene, low, high, frame).any())
    return False


def _hides(scene: Scene, low: FloatArray, high: FloatArray, frame: IntArray) -> BoolArray:
    """Return which pieces of the frame lie before or behind the leaves rather than around them."""
    covered = overlap_area(scene.low[frame], scene.high[frame], low, high)
    area = np.prod(scene.extents[frame][:, RECT], axis=1)
    solid = scene.facing[frame] >= 2.0 * FULL * area
    return np.asarray(solid & (covered >= 0.2 * float(np.prod((high - low)[RECT]))))


def _opens_to_viewer(scene: Scene, leaves: IntArray, frame: IntArray) -> bool:
    """Return a leaf opens to the side where it is nearer to the frame's face."""
    ahead = scene.low[leaves, FRONT].min() - scene.low[frame, FRONT].min()
    behind = scene.high[frame, FRONT].max() - scene.high[leaves, FRONT].max()
    return bool(ahead <= behind + 1e-9 * scene.size[FRONT])


def _leaf(scene: Scene, leaf: int, leaves: IntArray, group: IntArray) -> Mover:
    low = scene.low[leaf]
    high = scene.high[leaf]
    guesses: tuple[str, ...] = ()
    offset = _handle_offset(scene, leaf, group)
    if len(leaves) == 2:
        at_left = leaf == int(leaves[0])
    elif abs(offset) >= 0.2:
        at_left = offset > 0.0
    else:
        at_left = True
        guesses = ("has no handle at one side; hinge side assumed left",)
    origin = scene.middle[leaf].copy()
    origin[SIDEWAYS] = low[SIDEWAYS] if at_left else high[SIDEWAYS]
    axis = np.array([0.0, 0.0, -1.0 if at_left else 1.0])
    guesses = (*guesses, "hangs in a frame; which way and how far it opens is assumed")
    weight = float(np.prod((high - low)[RECT]))
    motion = Motion(JointKind.REVOLUTE, axis, origin, 0.0, DOOR_LIMIT)
    return Mover(PartKind.DOOR, motion, group, guesses, weight)


def _handle_offset(scene: Scene, leaf: int, group: IntArray) -> float:
    """Return where the foremost fittings are, from -0.5 (left) to 0.5 (right); 0 for none."""
    fittings = np.setdiff1d(group, [leaf])
    out = np.maximum(
        scene.low[leaf] - scene.low[fittings], scene.high[fittings] - scene.high[leaf]
    )[:, FRONT]
    if not len(fittings) or out.max() < scene.touch / 2.0:
        return 0.0
    handle = fittings[out >= 0.6 * out.max()]
    middle = scene.box_of(handle)[:, SIDEWAYS].sum() / 2.0
    return float((middle - scene.middle[leaf, SIDEWAYS]) / scene.extents[leaf, SIDEWAYS])
