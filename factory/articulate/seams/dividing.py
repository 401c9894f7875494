"""Panels without a seam between them, cut between their handles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from .handles import Protrusion
from .rectangles import Lines, Rectangle

#: A line that is covered so far between two handles is taken for the seam.
WEAK = 0.3
#: Handles are along one end of their panels if the room beyond the last is less than this share of
#: the room beyond the first.
ALONG_END = 0.4
#: Handles must be that far apart, as a share of what they divide.
LEAST_GAP = 0.01


def divided(
    rectangle: Rectangle, handles: Sequence[Protrusion], level: Lines, upright: Lines
) -> list[tuple[Rectangle, Protrusion]]:
    """Return a rectangle cut so that every piece has one handle; nothing if that cannot be.

    Args:
        rectangle: to cut.
        handles: the pulls in it.
        level: candidate lines, of which weak ones are good enough here.
        upright: likewise, vertical ones.
    """
    if len(handles) == 1:
        return [(rectangle, handles[0])]
    lines = (level, upright)
    gaps = [gap for axis in (0, 1) for gap in _gaps(rectangle, handles, axis, lines[axis])]
    if not gaps:
        return []
    # A seam that can be seen, however faint, before the widest gap without one.
    best = max(gaps, key=lambda gap: (gap.cover if gap.cover >= WEAK else 0.0, gap.share))
    axis = best.axis
    at = best.at
    lower, upper = _halves(rectangle, axis, at)
    below = [handle for handle in handles if handle.center[axis] < at]
    above = [handle for handle in handles if handle.center[axis] >= at]
    pieces = [divided(lower, below, level, upright), divided(upper, above, level, upright)]
    return [*pieces[0], *pieces[1]] if pieces[0] and pieces[1] else []


@dataclass(frozen=True)
class _Gap:
    """Room between handles.

    Attributes:
        axis: 0: between rows of handles; 1: between columns.
        share: of the rectangle.
        at: where to cut [pixels].
        cover: of the seam there.
    """

    axis: int
    share: float
    at: int
    cover: float


def _gaps(
    rectangle: Rectangle, handles: Sequence[Protrusion], axis: int, lines: Lines
) -> list[_Gap]:
    """Return where a line along the other axis passes between handles."""
    ordered = sorted(handles, key=lambda handle: float(handle.low[axis]))
    reach = float(ordered[0].high[axis])
    before = float(ordered[0].low[axis] - rectangle.low[axis])
    behind = float(rectangle.high[axis] - max(handle.high[axis] for handle in handles))
    found = []
    for handle in ordered[1:]:
        start = float(handle.low[axis])
        share = (start - reach) / max(float(rectangle.size[axis]), 1.0)
        if share >= LEAST_GAP:
            seam = _seam_between(lines, rectangle, axis, reach, start)
            at, cover = seam or (_unseen(reach, start, before, behind), 0.0)
            found.append(_Gap(axis, share, at, cover))
        reach = max(reach, float(handle.high[axis]))
    return found


def _seam_between(
    lines: Lines, rectangle: Rectangle, axis: int, start: float, stop: float
) -> tuple[int, float] | None:
    """Return where the best covered line between two places is, and its cover."""
    between = np.flatnonzero((lines.at > start) & (lines.at < stop))
    if len(between):
        cover = lines.covered(between, rectangle.low[1 - axis], rectangle.high[1 - axis])
        best = int(cover.argmax())
        if cover[best] >= WEAK:
            return int(lines.at[between[best]]), float(cover[best])
    return None


def _unseen(start: float, stop: float, before: float, behind: float) -> int:
    """Return where to cut between two handles if no seam is seen.

    Half-way; where handles are along one end of their panels, each keeps as much room there as the
    outermost has.

    Args:
        start: where the first of the handles ends.
        stop: where the second begins.
        before: room between the rectangle's first handle and its end.
        behind: between its last handle and its other end.
    """
    if behind < ALONG_END * before and start + behind < stop:
        return round(start + behind)
    if before < ALONG_END * behind and stop - before > start:
        return round(stop - before)
    return round((start + stop) / 2.0)


def _halves(rectangle: Rectangle, axis: int, at: int) -> tuple[Rectangle, Rectangle]:
    unseen = replace(rectangle, sides=np.zeros(4), relief=np.zeros(4))
    return unseen.with_side(2 * axis + 1, at), unseen.with_side(2 * axis, at)
