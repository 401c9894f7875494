"""The back edge of a panel, where it is seen from beside: how thick a door is."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ...geometry.crossings import Side
from .fronts import AROUND, Front
from .groups import FrontPanel

#: A panel that ends so near the outline is seen from beside [pixels].
AT_OUTLINE = 6
#: Its back edge is so far behind its rim: pixels, share of the object's depth, and of the panel's
#: shorter side.
NEAREST = 3.0
FARTHEST = 0.25
SLENDER = 0.5
#: A seam beside it is covered so far along the panel; alone, where two could be seen, so far.
COVERED = 0.7
ALONE = 0.85
#: Two that differ by less are one [pixels].
SAME = 3.0


def seen_thickness(
    fronts: Mapping[Side, Front], side: Side, panel: FrontPanel, rim: float
) -> float | None:
    """How far behind its rim a panel ends [m], as the seams beside it show; else ``None``.

    Args:
        fronts: the four sides.
        side: the panel's.
        panel: one that may reach to the outline.
        rim: depth of its outer edge in that side's frame [m].
    """
    _, _, first, last = fronts[side].relief.box
    right = side.frame[0]
    at_left = int(panel.rectangle.low[1]) - first <= AT_OUTLINE
    at_right = last - int(panel.rectangle.high[1]) <= AT_OUTLINE
    looking = {other: float(other.frame[2] @ right) for other in AROUND}
    beside = [
        fronts[other]
        for other in AROUND
        if (at_left and looking[other] > 0.5) or (at_right and looking[other] < -0.5)
    ]
    found = [_seam(fronts[side], panel, rim, other) for other in beside]
    seen = [each for each in found if each is not None]
    if not seen:
        return None
    pixel = fronts[side].relief.raster.pixel
    if len(seen) == 2 and abs(seen[0][0] - seen[1][0]) <= SAME * pixel:
        return (seen[0][0] + seen[1][0]) / 2.0
    thickness, cover = max(seen, key=lambda each: each[1])
    return thickness if len(beside) == 1 or cover >= ALONE else None


def _seam(front: Front, panel: FrontPanel, rim: float, beside: Front) -> tuple[float, float] | None:
    """The best upright seam behind a panel: how far behind its rim [m], and how far covered."""
    own = front.relief.raster
    raster = beside.relief.raster
    lines = beside.scene.upright
    along = float(raster.side.frame[0] @ own.side.frame[2])
    behind = along * (raster.low[0] + lines.at * raster.pixel) - rim
    shorter = float(panel.rectangle.size.min()) * own.pixel
    most = min(FARTHEST * front.relief.depth, SLENDER * shorter)
    near = np.flatnonzero((behind >= NEAREST * own.pixel) & (behind <= most))
    heights = own.low[1] + np.array([panel.rectangle.low[0], panel.rectangle.high[0]]) * own.pixel
    rows = np.clip(np.rint((heights - raster.low[1]) / raster.pixel), 0, raster.rows - 1)
    start, stop = rows.astype(np.int64)
    if not len(near) or stop <= start:
        return None
    covers = lines.covered(near, start, stop)
    best = int(covers.argmax())
    return (float(behind[near[best]]), float(covers[best])) if covers[best] >= COVERED else None
