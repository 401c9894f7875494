"""Knobs far apart on one strip, as stoves have them: turned, where knobs of drawers are pulled."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from .handles import ALIKE, FEWEST, IN_ROW, LONGEST, Face, Protrusion
from .rectangles import COVERED, Lines

#: A strip ends above and below its knobs within so many times their size.
STRIP = 4.0


def with_strips(face: Face, level: Lines, upright: Lines) -> tuple[Protrusion, ...]:
    """Return a face's handles; knobs on one strip without a seam between them are controls.

    Args:
        face: a side without handles.
        level: its candidates for horizontal seams.
        upright: likewise, for vertical ones.
    """
    controls: set[Protrusion] = set()
    longest = LONGEST * max(face.height.shape)
    small = [handle for handle in face.handles if handle.size.max() <= longest]
    for one in small:
        row = sorted((other for other in small if _level(one, other)), key=lambda h: h.center[1])
        if len(row) >= FEWEST and _on_strip(row, level) and not _parted(row, upright):
            controls |= set(row)
    return tuple(replace(h, control=True) if h in controls else h for h in face.handles)


def _level(one: Protrusion, other: Protrusion) -> bool:
    """Return whether two are of one size, side by side."""
    sizes = sorted([float(one.size.max()), float(other.size.max())])
    apart = abs(float(other.center[0] - one.center[0]))
    return sizes[1] <= ALIKE * sizes[0] and apart <= IN_ROW * sizes[0]


def _on_strip(row: Sequence[Protrusion], level: Lines) -> bool:
    """Return whether a line passes below all of them, and one above."""
    reach = STRIP * max(float(knob.size.max()) for knob in row)
    low = min(int(knob.low[0]) for knob in row)
    high = max(int(knob.high[0]) for knob in row)
    below = (level.at < low) & (level.at >= low - reach)
    above = (level.at > high) & (level.at <= high + reach)
    start = np.array([int(row[0].low[1])])
    stop = np.array([int(row[-1].high[1])])
    return all(
        bool((level.covered(np.flatnonzero(near), start, stop) >= COVERED).any())
        for near in (below, above)
    )


def _parted(row: Sequence[Protrusion], upright: Lines) -> bool:
    """Return whether a seam passes between two of them: then they are not on one strip."""
    size = max(float(knob.size.max()) for knob in row)
    last = upright.sums.shape[1] - 1
    for one, other in pairwise(row):
        between = np.flatnonzero((upright.at > one.high[1]) & (upright.at < other.low[1]))
        start = np.array([max(int(one.low[0] - size), 0)])
        stop = np.array([min(int(one.high[0] + size), last)])
        if (upright.covered(between, start, stop) >= COVERED).any():
            return True
    return False
