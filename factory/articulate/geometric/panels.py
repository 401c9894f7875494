"""Front panels: pieces that look like the front of a door or a drawer, and what is on them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...mesh import FloatArray, IntArray
from .scene import FRONT, RECT, SIDEWAYS, UP, Scene

MAX_SEEDS = 64
SMALLEST_AREA = 0.012
"""Of the whole front: anything smaller is trim."""
LEAST_FACING = 0.3
"""Of its rectangle: a door's frame around a window still counts."""
LONGEST_ASPECT = 12.0
THICKEST = 0.45
"""Thickness over the shorter side."""
LONGEST_HANDLE = 0.92
"""Of the panel's side: what runs along all of it is trim."""
LONGEST_GRIP = 0.3
"""Of the depth of a one-piece drawer: how far its grip reaches out."""
STANDS_OFF = 0.08
"""Pieces below this share of a panel do not hide it."""
HANDLE_AREA = 0.3
"""A handle's rectangle is at most this share of its panel's."""


@dataclass(frozen=True)
class Panel:
    """A slab in the front and what is mounted on it, view frame [m].

    Attributes:
        slabs: pieces that form the slab itself.
        low, high: box of the slabs, shape [3].
        mounted: further pieces that move along: handle, trim, glass.
        handle: box of the handle, shape [2, 3]; ``None`` if nothing protrudes.
        is_box: the one slab is a whole drawer in one piece; ``high`` is then that of its front
            only.
    """

    slabs: tuple[int, ...]
    low: FloatArray
    high: FloatArray
    mounted: tuple[int, ...] = ()
    handle: FloatArray | None = None
    is_box: bool = False

    @property
    def width(self) -> float:
        """Horizontal side [m]."""
        return float(self.high[SIDEWAYS] - self.low[SIDEWAYS])

    @property
    def height(self) -> float:
        """Vertical side [m]."""
        return float(self.high[UP] - self.low[UP])

    @property
    def depth(self) -> float:
        """Thickness [m]."""
        return float(self.high[FRONT] - self.low[FRONT])

    @property
    def area(self) -> float:
        """Of the front rectangle [m2]."""
        return self.width * self.height

    @property
    def center(self) -> FloatArray:
        """Of the slab's box [m], shape [3]."""
        return np.asarray((self.low + self.high) / 2.0)

    @property
    def has_side_handle(self) -> bool:
        """Whether an upright handle is near the left or right edge: it turns and does not slide."""
        if self.handle is None:
            return False
        width, _, height = self.handle[1] - self.handle[0]
        offset = abs(float(self.handle[:, SIDEWAYS].mean() - self.center[SIDEWAYS]))
        return bool(offset >= 0.3 * self.width and height >= 1.5 * width)

    @property
    def pieces(self) -> IntArray:
        """Slabs and what is mounted on them, sorted."""
        return np.array(sorted({*self.slabs, *self.mounted}), dtype=np.int64)


def find_panels(scene: Scene) -> tuple[Panel, ...]:
    """All slabs that could be seen from the front, largest first; no piece is in two of them."""
    seeds = [_panel(scene, (int(i),)) for i in _seed_pieces(scene)]
    seeds = _join_layers(scene, seeds)
    seeds += [_box_panel(scene, int(i)) for i in _box_pieces(scene)]
    seeds.sort(key=lambda seed: -round(seed.area, 12))
    seeds = _without_frame_strips([_with_frame(scene, seed, seeds) for seed in seeds])
    seeds = [_with_mounted(scene, seed, seeds) for seed in seeds]
    return tuple(panel for panel in _resolve_nesting(scene, seeds) if _is_visible(scene, panel))


def _panel(scene: Scene, slabs: tuple[int, ...]) -> Panel:
    index = list(slabs)
    return Panel(slabs, scene.low[index].min(axis=0), scene.high[index].max(axis=0))


def _seed_pieces(scene: Scene) -> IntArray:
    width, depth, height = scene.extents.T
    short = np.minimum(width, height)
    long = np.maximum(width, height)
    whole = scene.size[SIDEWAYS] * scene.size[UP]
    fits = (
        (width * height >= SMALLEST_AREA * whole)
        & (depth <= THICKEST * short)
        & (long <= LONGEST_ASPECT * short)
    )
    fits &= np.bincount(scene.labels) > 1
    fits &= scene.facing >= LEAST_FACING * width * height
    index = np.flatnonzero(fits)
    order = np.argsort(-(width * height)[index], kind="stable")
    return np.asarray(index[order][:MAX_SEEDS])


def _box_pieces(scene: Scene) -> IntArray:
    """Pieces that are drawers by themselves.

    Deep, with a flat front, open at the top, not the whole object.
    """
    width, depth, height = scene.extents.T
    whole = scene.size[SIDEWAYS] * scene.size[UP]
    deep = (depth > THICKEST * np.minimum(width, height)) & (depth >= 0.3 * scene.size[FRONT])
    part = (width * height >= SMALLEST_AREA * whole) & (width * height <= 0.8 * whole)
    inner = scene.high[:, UP] < scene.box[1, UP] - scene.touch / 4
    index = np.flatnonzero(deep & part & inner & (height <= 3.0 * width))
    return np.array(
        [
            i
            for i in index[:MAX_SEEDS]
            if _flat_front(scene, int(i)) is not None and is_open_box(scene, int(i))
        ],
        dtype=np.int64,
    )


def _flat_front(scene: Scene, piece: int) -> float | None:
    """Where a one-piece drawer has its front [m]: less deep than a handle that is one with it."""
    triangles = scene.triangles[scene.labels == piece]
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
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
    """Whether a ray from the middle leaves the piece upwards and meets its bottom downwards."""
    others = np.flatnonzero(np.arange(len(scene.low)) != piece)
    middle = (scene.low[piece] + scene.high[piece]) / 2.0
    middle[[SIDEWAYS, FRONT]] += 0.03 * scene.extents[piece, [SIDEWAYS, FRONT]]
    above, _ = scene.first_hit(middle, UP, 1, others)
    below, _ = scene.first_hit(middle, UP, -1, others)
    left, _ = scene.first_hit(middle, SIDEWAYS, -1, others)
    back, _ = scene.first_hit(middle, FRONT, 1, others)
    return bool(np.isinf(above) and np.isfinite(below) and np.isfinite(left) and np.isfinite(back))


def _box_panel(scene: Scene, piece: int) -> Panel:
    low = scene.low[piece].copy()
    high = scene.high[piece].copy()
    front = _flat_front(scene, piece)
    low[FRONT] = low[FRONT] if front is None else front
    high[FRONT] = low[FRONT] + 0.05 * scene.extents[piece, FRONT]
    return Panel((piece,), low, high, is_box=True)


def _join_layers(scene: Scene, seeds: list[Panel]) -> list[Panel]:
    """Sheets over the same rectangle, one behind the other, are one slab."""
    joined: list[Panel] = []
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


def _with_frame(scene: Scene, seed: Panel, seeds: list[Panel]) -> Panel:
    """Add strips that run along a side of the slab and touch it: a door of stiles and a filling."""
    if seed.is_box:
        return seed
    taken = {p for s in seeds for p in s.slabs if s.area > 0.35 * seed.area}
    width, depth, height = scene.extents.T
    tight = scene.touch / 4.0
    near = (scene.low <= seed.high + tight).all(axis=1) & (scene.high >= seed.low - tight).all(
        axis=1
    )
    thin = np.minimum(width, height) <= 0.35 * min(seed.width, seed.height)
    flush = np.minimum(scene.high[:, FRONT], seed.high[FRONT]) - np.maximum(
        scene.low[:, FRONT], seed.low[FRONT]
    )
    flush_enough = flush >= 0.4 * np.minimum(depth, seed.depth)
    upright = (np.abs(height - seed.height) <= 0.45 * seed.height) & (width < height)
    lying = (np.abs(width - seed.width) <= 0.45 * seed.width) & (height < width)
    shallow = depth <= max(3.0 * seed.depth, 0.15 * min(seed.width, seed.height))
    candidates = np.flatnonzero(near & thin & flush_enough & (upright | lying) & shallow)
    strips = [int(i) for i in candidates if int(i) not in taken]
    left_right = [i for i in strips if height[i] > width[i]]
    top_bottom = [i for i in strips if height[i] <= width[i]]
    if len(left_right) < 2 or len(top_bottom) < 2:
        return seed
    grown = _panel(scene, seed.slabs + tuple(strips))
    for other in seeds:
        outside = set(other.slabs).isdisjoint(grown.slabs) and other.area > 0.35 * seed.area
        outside = outside and bool(grown.low[FRONT] <= other.center[FRONT] <= grown.high[FRONT])
        if (
            outside
            and overlap_area(grown.low, grown.high, other.low, other.high) > 0.05 * other.area
        ):
            inside = overlap_area(seed.low, seed.high, other.low, other.high) > 0.9 * other.area
            if not inside:
                return seed
    return grown


def _without_frame_strips(seeds: list[Panel]) -> list[Panel]:
    """Drop the seeds that have become part of a larger one."""
    kept: list[Panel] = []
    for seed in seeds:
        if not any(
            set(seed.slabs) < set(other.slabs) or set(seed.slabs) == set(other.slabs)
            for other in kept
        ):
            kept.append(seed)
    return kept


def _with_mounted(scene: Scene, seed: Panel, seeds: list[Panel]) -> Panel:
    """Add small pieces in front of the slab: handle, knobs, trim; what protrudes is the handle."""
    shared = (
        np.minimum(scene.high, seed.high)[:, RECT] - np.maximum(scene.low, seed.low)[:, RECT] + HAIR
    )
    overlap = np.prod(np.maximum(shared, 0.0), axis=1)
    own = _rect_area(scene.extents)
    reach = max(0.12 * max(seed.width, seed.height), scene.touch)
    small = own <= HANDLE_AREA * max(seed.area, 1e-12)
    inside = overlap >= 0.6 * own
    near = (scene.high[:, FRONT] >= seed.low[FRONT] - reach) & (
        scene.high[:, FRONT] <= seed.high[FRONT] + 2 * scene.touch
    )
    ahead = scene.low[:, FRONT] <= seed.high[FRONT]
    other_slabs = {p for s in seeds for p in s.slabs}
    mounted = [
        int(i) for i in np.flatnonzero(small & inside & near & ahead) if int(i) not in seed.slabs
    ]
    far = small & inside & (scene.high[:, FRONT] < seed.low[FRONT]) & ~near
    mounted += [int(i) for i in np.flatnonzero(far) if _stands_on(scene, int(i), mounted)]
    loose = np.array(
        [i for i in mounted if i not in other_slabs or own[i] < 0.15 * seed.area], dtype=np.int64
    )
    return replace(
        seed, mounted=tuple(int(i) for i in loose), handle=_handle_box(scene, seed, loose)
    )


def _stands_on(scene: Scene, piece: int, posts: list[int]) -> bool:
    """Whether a piece is held by at least two of the others, as a bar by its posts."""
    low = scene.low[piece] - scene.touch / 4.0
    high = scene.high[piece] + scene.touch / 4.0
    return int(((scene.low[posts] <= high) & (scene.high[posts] >= low)).all(axis=1).sum()) >= 2


def _own_grip(scene: Scene, seed: Panel) -> FloatArray | None:
    """Box of what a one-piece drawer reaches out with before its front."""
    corners = scene.triangles[scene.labels == seed.slabs[0]].reshape(-1, 3)
    out = corners[corners[:, FRONT] < seed.low[FRONT] - 0.75 * scene.touch]
    return np.stack([out.min(axis=0), out.max(axis=0)]) if len(out) else None


def _handle_box(scene: Scene, seed: Panel, mounted: IntArray) -> FloatArray | None:
    if seed.is_box and (grip := _own_grip(scene, seed)) is not None:
        return grip
    outer = _protruding(scene, seed, mounted)
    if not len(outer) or _is_crowded(scene, seed, outer):
        return None
    box = np.stack([scene.low[outer].min(axis=0), scene.high[outer].max(axis=0)])
    sides = (box[1] - box[0])[RECT] / np.array([seed.width, seed.height])
    if float(np.prod(sides)) > HANDLE_AREA or sides.min() > 0.5:
        return None
    return None if sides.max() > LONGEST_HANDLE and not _is_inset_bar(seed, box) else box


def _protruding(scene: Scene, seed: Panel, mounted: IntArray) -> IntArray:
    """Those of the mounted pieces that stand out furthest; none if nothing stands out."""
    protrusion = seed.low[FRONT] - scene.low[mounted, FRONT]
    longest = float(protrusion.max(initial=0.0))
    return np.asarray(mounted[(protrusion >= 0.6 * longest) & (longest >= 0.75 * scene.touch)])


def is_crowded(scene: Scene, panel: Panel) -> bool:
    """Whether several grips say that the panel is several fronts in one piece.

    More than two; two that are not level; or two side by side in the middle, as of a pair of doors.
    """
    return _is_crowded(
        scene, panel, _protruding(scene, panel, np.array(panel.mounted, dtype=np.int64))
    )


def _is_crowded(scene: Scene, panel: Panel, outer: IntArray) -> bool:
    boxes: list[tuple[FloatArray, FloatArray]] = []
    for piece in outer:
        low = scene.low[piece] - scene.touch
        high = scene.high[piece] + scene.touch
        near = [
            k
            for k, (other_low, other_high) in enumerate(boxes)
            if (low <= other_high).all() and (high >= other_low).all()
        ]
        for k in reversed(near):
            low = np.minimum(low, boxes[k][0])
            high = np.maximum(high, boxes[k][1])
            del boxes[k]
        boxes.append((low, high))
    middles = [(low + high) / 2.0 for low, high in boxes]
    if len(middles) != 2:
        return len(middles) > 2
    apart = np.abs(middles[0] - middles[1])
    return bool(apart[UP] > apart[SIDEWAYS] or apart[SIDEWAYS] < 0.3 * panel.width)


def _is_inset_bar(seed: Panel, box: FloatArray) -> bool:
    """A thin bar along a whole side, off the panel's edge: a long handle, not an edge strip."""
    sides = np.array([seed.width, seed.height])
    across = int(np.argmin((box[1] - box[0])[RECT] / sides))
    low = box[0][RECT][across] - seed.low[RECT][across]
    high = seed.high[RECT][across] - box[1][RECT][across]
    thin = (box[1] - box[0])[RECT][across] <= 0.15 * sides[across]
    return bool(thin and min(low, high) >= 0.02 * sides[across])


def _resolve_nesting(scene: Scene, seeds: list[Panel]) -> list[Panel]:
    """Slabs within a slab: fillings and trims join it; panels with own handles make it a frame."""
    absorbed: set[int] = set()
    frames: set[int] = set()
    extra: dict[int, list[int]] = {}
    for k, seed in enumerate(seeds):
        for m in range(k - 1, -1, -1):
            host = seeds[m]
            if m in absorbed or not _within(scene, seed, host):
                continue
            in_front = seed.center[FRONT] <= host.center[FRONT] + scene.touch / 2
            handled = seed.handle is not None and not _own_handle(host, seed)
            independent = in_front and handled and seed.area >= 0.15 * host.area
            if independent:
                frames.add(m)
            else:
                extra.setdefault(m, []).extend(int(p) for p in seed.pieces)
                absorbed.add(k)
            break
    kept = []
    for k, seed in enumerate(seeds):
        if k in absorbed or k in frames:
            continue
        kept.append(
            replace(
                seed, mounted=tuple(sorted({*seed.mounted, *extra.get(k, [])} - set(seed.slabs)))
            )
        )
    return _unshare(scene, kept)


def _own_handle(host: Panel, inner: Panel) -> bool:
    if host.handle is None or inner.handle is None:
        return host.handle is not None
    rect = overlap_area(host.handle[0], host.handle[1], inner.low, inner.high)
    return rect < 0.5 * float(np.prod((host.handle[1] - host.handle[0])[RECT]))


def _within(scene: Scene, inner: Panel, host: Panel) -> bool:
    ahead = host.low[FRONT] - inner.high[FRONT] <= scene.touch
    behind = inner.low[FRONT] - host.high[FRONT] <= scene.touch / 4.0
    covered = overlap_area(inner.low, inner.high, host.low, host.high) >= 0.9 * inner.area
    return bool(covered and ahead and behind and not inner.is_box and not host.is_box)


def _unshare(scene: Scene, panels: list[Panel]) -> list[Panel]:
    """A piece mounted on two panels stays with the one it overlaps most, else the smaller one."""
    best: dict[int, tuple[float, float, int]] = {}
    for k, panel in enumerate(panels):
        for piece in panel.mounted:
            overlap = overlap_area(scene.low[piece], scene.high[piece], panel.low, panel.high)
            key = (round(overlap, 9), -panel.area, -k)
            if piece not in best or key > best[piece]:
                best[piece] = key
    slabs = {p for panel in panels for p in panel.slabs}
    result = []
    for k, panel in enumerate(panels):
        mine = np.array(
            [p for p in panel.mounted if -best[p][2] == k and p not in slabs], dtype=np.int64
        )
        result.append(
            replace(
                panel, mounted=tuple(int(p) for p in mine), handle=_handle_box(scene, panel, mine)
            )
        )
    return result


def _is_visible(scene: Scene, panel: Panel) -> bool:
    """Whether most rays from the front meet the panel first; what stands off it is ignored."""
    hits = 0
    small = np.flatnonzero(_rect_area(scene.extents) < STANDS_OFF * panel.area)
    through = np.setdiff1d(small, panel.pieces)
    start = scene.box[0, FRONT] - scene.touch
    shares = (0.15, 0.5, 0.85)
    for u in shares:
        for v in shares:
            x = panel.low[SIDEWAYS] + u * panel.width
            z = panel.low[UP] + v * panel.height
            _, piece = scene.first_hit(np.array([x, start, z]), FRONT, 1, through)
            hits += piece in panel.pieces
    return hits >= 5


def overlap_area(
    low: FloatArray, high: FloatArray, other_low: FloatArray, other_high: FloatArray
) -> float:
    """Area that two boxes share, seen from the front [m2]; a line's width counts as a hair."""
    sides = np.minimum(high, other_high)[RECT] - np.maximum(low, other_low)[RECT] + HAIR
    return float(np.prod(np.maximum(sides, 0.0)))


HAIR = 1e-9


def _rect_area(extents: FloatArray) -> FloatArray:
    return np.asarray((extents[:, SIDEWAYS] + HAIR) * (extents[:, UP] + HAIR))
