"""Knobs of a pair of doors that have grown together over the seam between them."""

from dataclasses import replace

import numpy as np

from .handles import LONGEST_KNOB, Face, Protrusion
from .rectangles import Lines

#: The seam passes between these shares of the width, and is covered so far above or below.
MIDDLE = (0.3, 0.7)
COVERED = 0.9
#: It is looked at over so many times the handle's height, and so many pixels at least.
REACH = 6.0
LEAST_REACH = 24


def parted(face: Face, upright: Lines) -> Face:
    """Return a face whose handles on an upright seam are two each, one on either side.

    Args:
        face: a side without handles.
        upright: its candidates for upright seams.
    """
    handles = (half for handle in face.handles for half in _halves(handle, upright))
    return replace(face, handles=tuple(handles))


def _halves(handle: Protrusion, upright: Lines) -> tuple[Protrusion, ...]:
    rows, columns = handle.size
    if columns > LONGEST_KNOB * rows:
        return (handle,)
    share = (upright.at - handle.low[1]) / columns
    reach = int(max(REACH * rows, LEAST_REACH))
    last = upright.relief.shape[1] - 1
    ends = np.array(
        [handle.low[0] - reach, handle.low[0], handle.high[0] + 1, handle.high[0] + reach]
    )
    start = ends[[0, 2]]
    stop = ends[[1, 3]]
    inside = np.flatnonzero((start >= 0) & (stop <= last))
    lines = np.flatnonzero((share >= MIDDLE[0]) & (share <= MIDDLE[1]))
    if not len(inside) or not len(lines):
        return (handle,)
    covers = upright.in_relief(lines[:, None], start[inside], stop[inside]).max(axis=1)
    if covers.max() < COVERED:
        return (handle,)
    return handle.split(int(upright.at[lines[int(covers.argmax())]]))
