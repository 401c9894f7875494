"""Hollows behind a panel: boxes between walls, as deep as the parts behind allow."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from ...config import SolidsConfig
from ...mesh import BoolArray, FloatArray
from .box import Box
from .lattice import Lattice

#: A hollow is looked for in this many slices of its depth.
SLICES = 5
#: Slices whose sides differ by less are one [m].
ALIKE_M = 0.012
#: Or by less than so many cells.
ALIKE_CELLS = 1.5
#: Hollows narrower or shallower than a wall is thick are none [m].
LEAST_M = SolidsConfig.wall_m
#: Share of a hollow's cells that may lie outside what can be hollowed.
SPILT = 0.02


def hollow(lattice: Lattice, room: BoolArray, column: Box, frame: FloatArray) -> tuple[Box, ...]:
    """Return the largest boxes, one behind the other, in which everything can be hollowed.

    They lie in a ``column`` and have, as that, the axes of a panel's frame (rows), the first one at
    the column's front; none without room: cells at least a wall's thickness below the mesh.
    """
    # Slices share their ends to the last bit, or a skin would be left between them.
    depths = np.linspace(column.low[2], column.high[2], SLICES + 1)
    found: list[Box] = []
    for front, back in pairwise(depths):
        before = found[-1] if found else column
        box = _shrunk(lattice, room, column.shared(before).between(front, back), frame)
        if box is None:
            break
        found.append(box)
        if box.high[2] < back - 1e-9:
            break
    return _merged(found, max(ALIKE_M, ALIKE_CELLS * lattice.step))


def _shrunk(lattice: Lattice, room: BoolArray, box: Box, frame: FloatArray) -> Box | None:
    """Return a box in which all may be hollowed: the worst side is moved in until that is so."""
    span = lattice.span(box.turned(frame.T))
    axes = np.abs(frame).argmax(axis=1)
    signs = frame[np.arange(3), axes]
    free = room[span].transpose(axes)
    free = free[tuple(slice(None, None, -1) if sign < 0 else slice(None) for sign in signs)]
    lines = [
        np.sort(lattice.lines[axis][span[axis].start : span[axis].stop + 1] * sign)
        for axis, sign in zip(axes, signs, strict=True)
    ]
    ends = [[0, size] for size in free.shape]
    while all(high > low for low, high in ends):
        inner = free[tuple(slice(*end) for end in ends)]
        if 1.0 - inner.mean() <= SPILT:
            break
        worst = [
            (1.0 - np.take(inner, [0, -1][side], axis=axis).mean(), axis, side)
            for axis, side in ((0, 0), (0, 1), (1, 0), (1, 1), (2, 1))
        ]
        _, axis, side = max(worst)
        ends[axis][side] += -1 if side else 1
    if any(high <= low for low, high in ends):
        return None
    reached = np.array([line[end] for line, end in zip(lines, ends, strict=True)])
    low = np.maximum(reached[:, 0], box.low)
    high = np.minimum(reached[:, 1], box.high)
    low[2] = box.low[2]
    if ends[2][1] == free.shape[2]:
        high[2] = box.high[2]
    shrunk = Box(low, high)
    return None if (shrunk.size[:2] < LEAST_M).any() or shrunk.size[2] <= 0.0 else shrunk


def _merged(slices: list[Box], alike: float) -> tuple[Box, ...]:
    kept: list[Box] = []
    for box in slices:
        last = kept[-1] if kept else box
        off = np.abs([box.low - last.low, box.high - last.high])[:, :2]
        if not kept or off.max() >= alike:
            kept.append(box)
            continue
        kept[-1] = last.shared(box).between(last.low[2], box.high[2])
    return tuple(box for box in kept if kept[-1].high[2] - kept[0].low[2] >= LEAST_M)
