"""Front panels: pieces that look like the front of a door or a drawer, and pieces on them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...geometry.triangles import doubled_normals
from ...mesh import IntArray
from .mounted import with_mounted
from .nesting import is_visible, resolve_nesting
from .scene import FRONT, PLAN, SIDEWAYS, UP, Scene
from .slab import FrontSlab, overlap_area

MAX_SEEDS = 64
SMALLEST_AREA = 0.012
"""Of the whole front: anything smaller is trim."""
LEAST_FACING = 0.3
"""Of its rectangle: a door's frame around a window still counts."""
LONGEST_ASPECT = 12.0
THICKEST = 0.45
"""Thickness over the shorter side."""
LONGEST_GRIP = 0.3
"""Of the depth of a one-piece drawer: how far its grip reaches out."""


def find_panels(scene: Scene) -> tuple[FrontSlab, ...]:
    """Find all slabs that could be seen from the front, largest first; no piece is in two."""
    seeds = [_panel(scene, (int(i),)) for i in _seed_pieces(scene)]
    seeds = _join_layers(scene, seeds)
    seeds += _box_panels(scene)
    seeds.sort(key=lambda seed: -round(seed.area, 12))
    seeds = _without_frame_strips([_with_frame(scene, seed, seeds) for seed in seeds])
    seeds = [with_mounted(scene, seed, seeds) for seed in seeds]
    return tuple(panel for panel in resolve_nesting(scene, seeds) if is_visible(scene, panel))


def _panel(scene: Scene, slabs: tuple[int, ...]) -> FrontSlab:
    return FrontSlab(slabs, *scene.box_of(list(slabs)))


def _seed_pieces(scene: Scene) -> IntArray:
    width, depth, height = scene.extents.T
    short = np.minimum(width, height)
    long = np.maximum(width, height)
    fits = (
        (width * height >= SMALLEST_AREA * scene.front_area)
        & (depth <= THICKEST * short)
        & (long <= LONGEST_ASPECT * short)
    )
    fits &= np.bincount(scene.labels) > 1
    fits &= scene.facing >= LEAST_FACING * width * height
    index = np.flatnonzero(fits)
    order = np.argsort(-(width * height)[index], kind="stable")
    return np.asarray(index[order][:MAX_SEEDS])


def _box_panels(scene: Scene) -> Iterator[FrontSlab]:
    """Yield the fronts of pieces that are drawers by themselves.

    Deep, with a flat front, open at the top, not the whole object.
    """
    width, depth, height = scene.extents.T
    whole = scene.front_area
    deep = (depth > THICKEST * np.minimum(width, height)) & (depth >= 0.3 * scene.size[FRONT])
    part = (width * height >= SMALLEST_AREA * whole) & (width * height <= 0.8 * whole)
    inner = scene.high[:, UP] < scene.box[1, UP] - scene.touch / 4
    index = np.flatnonzero(deep & part & inner & (height <= 3.0 * width))
    for piece in index[:MAX_SEEDS].tolist():
        front = _flat_front(scene, piece)
        if front is not None and is_open_box(scene, piece):
            low = scene.low[piece].copy()
            high = scene.high[piece].copy()
            low[FRONT] = front
            high[FRONT] = front + 0.05 * scene.extents[piece, FRONT]
            yield FrontSlab((piece,), low, high, is_box=True)


def _flat_front(scene: Scene, piece: int) -> float | None:
    """Return where a one-piece drawer has its front [m]: behind a handle that is one with it."""
    triangles = scene.triangles[scene.labels == piece]
    normals = doubled_normals(triangles)
    width, depth, height = scene.extents[piece]
    area = np.abs(normals[:, FRONT]) / 2.0
    start = float(scene.low[piece, FRONT])
    for share in np.arange(0.0, LONGEST_GRIP, 0.025):
        limits = start + share * depth, start + (share + 0.05) * depth
        depths = triangles[:, :, FRONT]
        front = (depths.min(axis=1) >= limits[0]) & (depths.max(axis=1) <= limits[1])
        if area[front].sum() >= 0.6 * width * height:
            return float(depths[front].min())
    return None


def is_open_box(scene: Scene, piece: int) -> bool:
    """Tell whether a ray from the middle leaves the piece upwards and meets its bottom."""
    others = np.flatnonzero(np.arange(len(scene.low)) != piece)
    middle = scene.middle[piece].copy()
    middle[PLAN] += 0.03 * scene.extents[piece, PLAN]
    ways = [(UP, 1), (UP, -1), (SIDEWAYS, -1), (FRONT, 1)]
    above, *around = scene.distances(middle, ways, others)
    return bool(np.isinf(above) and np.isfinite(around).all())


def _join_layers(scene: Scene, seeds: list[FrontSlab]) -> list[FrontSlab]:
    """Join sheets over the same rectangle, one behind the other, to one slab."""
    joined: list[FrontSlab] = []
    for seed in seeds:
        for k, other in enumerate(joined):
            same = overlap_area(seed.low, seed.high, other.low, other.high) > 0.85 * max(
                seed.area, other.area
            )
            gap = max(seed.low[FRONT] - other.high[FRONT], other.low[FRONT] - seed.high[FRONT])
            thickness = max(seed.high[FRONT], other.high[FRONT]) - min(
                seed.low[FRONT], other.low[FRONT]
            )
            thin = thickness <= THICKEST / 2 * min(other.width, other.height)
            if same and thin and gap <= max(scene.touch, 0.05 * min(other.width, other.height)):
                joined[k] = _panel(scene, other.slabs + seed.slabs)
                break
        else:
            joined.append(seed)
    return joined


def _with_frame(scene: Scene, seed: FrontSlab, seeds: list[FrontSlab]) -> FrontSlab:
    """Add strips that run along a side of the slab and touch it: a door of stiles and a filling."""
    if seed.is_box:
        return seed
    taken = {p for s in seeds for p in s.slabs if s.area > 0.35 * seed.area}
    width, depth, height = scene.extents.T
    tight = scene.touch / 4.0
    near = scene.meeting(seed.low - tight, seed.high + tight)
    thin = np.minimum(width, height) <= 0.35 * min(seed.width, seed.height)
    flush = np.minimum(scene.high[:, FRONT], seed.high[FRONT]) - np.maximum(
        scene.low[:, FRONT], seed.low[FRONT]
    )
    flush_enough = flush >= 0.4 * np.minimum(depth, seed.depth)
    upright = (np.abs(height - seed.height) <= 0.45 * seed.height) & (width < height)
    lying = (np.abs(width - seed.width) <= 0.45 * seed.width) & (height < width)
    shallow = depth <= max(3.0 * seed.depth, 0.15 * min(seed.width, seed.height))
    candidates = np.flatnonzero(near & thin & flush_enough & (upright | lying) & shallow)
    strips = [i for i in candidates.tolist() if i not in taken]
    left_right = sum(height[i] > width[i] for i in strips)
    if min(left_right, len(strips) - left_right) < 2:
        return seed
    return _panel(scene, seed.slabs + tuple(strips))


def _without_frame_strips(seeds: list[FrontSlab]) -> list[FrontSlab]:
    """Drop the seeds that have become part of a larger one."""
    kept: list[FrontSlab] = []
    for seed in seeds:
        if not any(set(seed.slabs) <= set(other.slabs) for other in kept):
            kept.append(seed)
    return kept
