"""Pieces mounted on a panel: handles, knobs, trim; and whether its surroundings are crowded."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...mesh import FloatArray, IntArray
from .scene import FRONT, RECT, SIDEWAYS, UP, Scene
from .slab import FrontSlab, overlap_area, rect_area

LONGEST_HANDLE = 0.92
"""Of the panel's side: what runs along all of it is trim."""
HANDLE_AREA = 0.3
"""A handle's rectangle is at most this share of its panel's."""


def with_mounted(scene: Scene, seed: FrontSlab, seeds: list[FrontSlab]) -> FrontSlab:
    """Add small pieces in front of the slab: handle, knobs, trim; what protrudes is the handle."""
    overlap = overlap_area(scene.low, scene.high, seed.low, seed.high)
    own = rect_area(scene.extents)
    reach = max(0.12 * max(seed.width, seed.height), scene.touch)
    small = own <= HANDLE_AREA * max(seed.area, 1e-12)
    inside = overlap >= 0.6 * own
    near = (scene.high[:, FRONT] >= seed.low[FRONT] - reach) & (
        scene.high[:, FRONT] <= seed.high[FRONT] + 2 * scene.touch
    )
    ahead = scene.low[:, FRONT] <= seed.high[FRONT]
    other_slabs = {p for s in seeds for p in s.slabs}
    on_it = small & inside & near & ahead & scene.without(np.array(seed.slabs))
    mounted = np.flatnonzero(on_it).tolist()
    far = small & inside & (scene.high[:, FRONT] < seed.low[FRONT]) & ~near
    mounted += [i for i in np.flatnonzero(far).tolist() if _stands_on(scene, i, mounted)]
    loose = [i for i in mounted if i not in other_slabs or own[i] < 0.15 * seed.area]
    return holding(scene, seed, loose)


def holding(scene: Scene, seed: FrontSlab, mounted: Sequence[int]) -> FrontSlab:
    """Return a slab with these pieces mounted on it, and the handle that they make."""
    return replace(seed, mounted=tuple(mounted), handle=_handle_box(scene, seed, mounted))


def _stands_on(scene: Scene, piece: int, posts: list[int]) -> bool:
    """Return whether a piece is held by at least two of the others, as a bar by its posts."""
    low = scene.low[piece] - scene.touch / 4.0
    high = scene.high[piece] + scene.touch / 4.0
    return int(scene.meeting(low, high)[posts].sum()) >= 2


def _own_grip(scene: Scene, seed: FrontSlab) -> FloatArray | None:
    """Return the box of what a one-piece drawer reaches out with before its front."""
    corners = scene.triangles[scene.labels == seed.slabs[0]].reshape(-1, 3)
    out = corners[corners[:, FRONT] < seed.low[FRONT] - 0.75 * scene.touch]
    return np.stack([out.min(axis=0), out.max(axis=0)]) if len(out) else None


def _handle_box(scene: Scene, seed: FrontSlab, mounted: Sequence[int]) -> FloatArray | None:
    """Return the box of what can be held on a panel, shape [2, 3]; ``None`` if nothing."""
    if seed.is_box and (grip := _own_grip(scene, seed)) is not None:
        return grip
    outer = _protruding(scene, seed, mounted)
    if not len(outer) or _crowded(scene, seed, outer):
        return None
    box = scene.box_of(outer)
    sides = (box[1] - box[0])[RECT] / np.array([seed.width, seed.height])
    if float(np.prod(sides)) > HANDLE_AREA or sides.min() > 0.5:
        return None
    return None if sides.max() > LONGEST_HANDLE and not _is_inset_bar(seed, box) else box


def _protruding(scene: Scene, seed: FrontSlab, mounted: Sequence[int]) -> IntArray:
    """Return those of the mounted pieces that stand out furthest; none if nothing stands out."""
    pieces = np.array(mounted, dtype=np.int64)
    protrusion = seed.low[FRONT] - scene.low[pieces, FRONT]
    longest = float(protrusion.max(initial=0.0))
    return np.asarray(pieces[(protrusion >= 0.6 * longest) & (longest >= 0.75 * scene.touch)])


def is_crowded(scene: Scene, panel: FrontSlab) -> bool:
    """Return whether several grips say that the panel is several fronts in one piece.

    More than two; two that are not level; or two side by side in the middle, as of a pair of doors.
    """
    return _crowded(scene, panel, _protruding(scene, panel, panel.mounted))


def _crowded(scene: Scene, panel: FrontSlab, outer: IntArray) -> bool:
    labels = scene.label_touching(outer, 2.0 * scene.touch)
    middles = [scene.box_of(outer[labels == grip]).mean(axis=0) for grip in np.unique(labels)]
    if len(middles) != 2:
        return len(middles) > 2
    apart = np.abs(middles[0] - middles[1])
    return bool(apart[UP] > apart[SIDEWAYS] or apart[SIDEWAYS] < 0.3 * panel.width)


def _is_inset_bar(seed: FrontSlab, box: FloatArray) -> bool:
    """Tell whether it is a thin bar along a whole side, off the edge: a long handle."""
    sides = np.array([seed.width, seed.height])
    across = int(np.argmin((box[1] - box[0])[RECT] / sides))
    low = box[0][RECT][across] - seed.low[RECT][across]
    high = seed.high[RECT][across] - box[1][RECT][across]
    thin = (box[1] - box[0])[RECT][across] <= 0.15 * sides[across]
    return bool(thin and min(low, high) >= 0.02 * sides[across])
