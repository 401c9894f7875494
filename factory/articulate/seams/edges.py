"""The back edge of a panel, where it is seen from beside: how thick a door is."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ...mesh import FloatArray
from ...views.raster import Side
from .fronts import AROUND, Front, thickness
from .rectangles import Rectangle

#: A panel that ends so near the outline is seen from beside [pixels].
AT_OUTLINE = 6
#: Its back edge is so far behind its rim: pixels, share of the object's depth, and of the panel's
#: shorter side; where nobody sees it, that share of the depth.
NEAREST = 3.0
FARTHEST = 0.25
SLENDER = 0.5
USUAL = 0.04
#: A seam beside it is covered so far along the panel; alone, where two could be seen, so far.
COVERED = 0.7
ALONE = 0.85
#: Two that differ by less are one [pixels].
SAME = 3.0
#: Nothing lies behind a panel that is at most so thick, as a share of its shorter side, of an
#: object that is no deeper than that share of it.
LEAF = 0.16
SHALLOW = 0.5


def leaf_thickness(front: Front, panel: Rectangle) -> float | None:
    """Return how thick a panel is that is seen from behind as well [m]; ``None`` of others.

    A door between two rooms: whatever is in its rectangle moves with it.
    """
    window = panel.window
    pixel = front.relief.raster.pixel
    shorter = float(panel.size.min()) * pixel
    both = front.relief.seen[window] & front.behind.seen[:, ::-1][window]
    if not both.any() or front.relief.depth > SHALLOW * shorter:
        return None
    thick = float(np.median(thickness(front.relief, front.behind)[window][both])) * pixel
    return thick if thick <= LEAF * shorter else None


def thickness_behind(
    fronts: Mapping[Side, Front], side: Side, panel: Rectangle, rim: float
) -> float:
    """Return how far behind its rim a panel ends [m], as the seams beside it show, or usually.

    Args:
        fronts: the four sides.
        side: the panel's.
        panel: one that may reach to the outline.
        rim: depth of its outer edge in that side's frame [m].
    """
    relief = fronts[side].relief
    usual = max(USUAL * relief.depth, NEAREST * relief.raster.pixel)
    beside = _beside(fronts, side, panel)
    found = [_seams(fronts[side], panel, rim, other) for other in beside]
    pair = _agreeing(found, fronts[side])
    if pair is not None:
        return pair
    seen = np.concatenate([*found, [[usual, 0.0]]])
    thickness, cover = seen[seen[:, 1].argmax()].tolist()
    return thickness if len(beside) == 1 or cover >= ALONE else usual


def _agreeing(found: Sequence[FloatArray], front: Front) -> float | None:
    """Return how far behind the rim [m] two sides show a seam, the best covered one."""
    if len(found) != 2:
        return None
    (one, other) = found
    apart = np.abs(one[:, None, 0] - other[None, :, 0])
    cover = one[:, None, 1] + other[None, :, 1]
    cover = np.where(apart <= SAME * front.relief.raster.pixel, cover, 0.0)
    if not cover.any():
        return None
    at, beside = np.unravel_index(int(cover.argmax()), cover.shape)
    return float(one[at, 0] + other[beside, 0]) / 2.0


def _beside(fronts: Mapping[Side, Front], side: Side, panel: Rectangle) -> list[Front]:
    """Return the sides that a panel reaches."""
    first, last = fronts[side].relief.box[:, 1]
    right = side.frame[0]
    at_left = int(panel.low[1]) - first <= AT_OUTLINE
    at_right = last - int(panel.high[1]) <= AT_OUTLINE
    looking = {other: float(other.frame[2] @ right) for other in AROUND}
    return [
        fronts[other]
        for other in AROUND
        if (at_left and looking[other] > 0.5) or (at_right and looking[other] < -0.5)
    ]


def _seams(front: Front, panel: Rectangle, rim: float, beside: Front) -> FloatArray:
    """Return upright seams behind a panel: how far behind its rim [m], how far covered; [n, 2]."""
    own = front.relief.raster
    raster = beside.relief.raster
    lines = beside.upright
    along = float(raster.side.frame[0] @ own.side.frame[2])
    behind = along * (raster.low[0] + lines.at * raster.pixel) - rim
    shorter = float(panel.size.min()) * own.pixel
    most = min(FARTHEST * front.relief.depth, SLENDER * shorter)
    near = np.flatnonzero((behind >= NEAREST * own.pixel) & (behind <= most))
    heights = own.low[1] + np.array([panel.low[0], panel.high[0]]) * own.pixel
    rows = np.clip(np.rint((heights - raster.low[1]) / raster.pixel), 0, raster.rows - 1)
    start, stop = rows.astype(np.int64)
    if stop <= start:
        return np.zeros((0, 2))
    covers = lines.covered(near, start, stop)
    seen = covers >= COVERED
    return np.stack([behind[near[seen]], covers[seen]], axis=1)
