"""Panels within panels, panels that share pieces, panels that nobody sees."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .mounted import holding
from .scene import FRONT, RECT, Scene
from .slab import FrontSlab, overlap_area, rect_area

#: Pieces below this share of a panel do not hide it.
STANDS_OFF = 0.08


def resolve_nesting(scene: Scene, seeds: list[FrontSlab]) -> list[FrontSlab]:
    """Join fillings and trims to the slab around them; panels with handles make it a frame."""
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
                extra.setdefault(m, []).extend(seed.pieces.tolist())
                absorbed.add(k)
            break
    kept = [
        replace(seed, mounted=tuple(sorted({*seed.mounted, *extra.get(k, [])} - set(seed.slabs))))
        for k, seed in enumerate(seeds)
        if k not in absorbed and k not in frames
    ]
    return _unshare(scene, kept)


def _own_handle(host: FrontSlab, inner: FrontSlab) -> bool:
    if host.handle is None or inner.handle is None:
        return host.handle is not None
    rect = overlap_area(host.handle[0], host.handle[1], inner.low, inner.high)
    return bool(rect < 0.5 * np.prod((host.handle[1] - host.handle[0])[RECT]))


def _within(scene: Scene, inner: FrontSlab, host: FrontSlab) -> bool:
    ahead = host.low[FRONT] - inner.high[FRONT] <= scene.touch
    behind = inner.low[FRONT] - host.high[FRONT] <= scene.touch / 4.0
    covered = overlap_area(inner.low, inner.high, host.low, host.high) >= 0.9 * inner.area
    return bool(covered and ahead and behind and not inner.is_box and not host.is_box)


def _unshare(scene: Scene, panels: list[FrontSlab]) -> list[FrontSlab]:
    """Leave a piece on two panels to the one it overlaps most, else to the smaller one."""
    best: dict[int, tuple[float, float, int]] = {}
    for k, panel in enumerate(panels):
        for piece in panel.mounted:
            overlap = overlap_area(scene.low[piece], scene.high[piece], panel.low, panel.high)
            key = (round(float(overlap), 9), -panel.area, -k)
            if piece not in best or key > best[piece]:
                best[piece] = key
    slabs = {p for panel in panels for p in panel.slabs}
    return [
        holding(scene, panel, [p for p in panel.mounted if -best[p][2] == k and p not in slabs])
        for k, panel in enumerate(panels)
    ]


def is_visible(scene: Scene, panel: FrontSlab) -> bool:
    """Tell whether most rays from the front meet the panel first, whatever stands off it."""
    small = np.flatnonzero(rect_area(scene.extents) < STANDS_OFF * panel.area)
    through = np.setdiff1d(small, panel.pieces)
    start = scene.box[0, FRONT] - scene.touch
    shares = (0.15, 0.5, 0.85)
    first = [
        scene.first_hit(panel.point(u, start, v), FRONT, 1, through)[1]
        for u in shares
        for v in shares
    ]
    return int(np.isin(first, panel.pieces).sum()) >= 5
