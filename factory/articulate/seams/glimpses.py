"""Panels of which the picture network alone is sure: flush doors without a seam or a handle."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from ...mesh import FloatArray, IntArray
from .candidates import main_pulls
from .fronts import Front
from .panels import FrontPanel
from .rectangles import Rectangle
from .sight import SQUARE, Sight

#: A square belongs to a panel, and one to an end of it, from this probability.
LIKELY = 0.4
#: What is seen must be so sure, fill its rectangle so far, and end at its sides so surely.
SURE = 0.85
FULL = 0.9
ENDS = 0.75
LEAST_SQUARES = 60


@dataclass(frozen=True, eq=False)
class _SeenPatch:
    """Squares of panels without an end in between.

    Attributes:
        low, high: first row and column, and those after the last, shape [2] each.
        full: share of them that belongs to the patch.
    """

    low: IntArray
    high: IntArray
    full: float


def glimpsed(front: Front) -> tuple[FrontPanel, ...]:
    """The panels of one side that the network alone is sure of."""
    found = []
    for patch in _patches(front.sight):
        sides = _ends(front.sight, patch)
        rectangle = _rectangle(patch, sides, front.relief.shape)
        sure = front.sight.shows(rectangle)
        if patch.full < FULL or sure < SURE or sides.mean() < ENDS:
            continue
        handles = front.scene.handles_in(rectangle)
        if len(main_pulls(handles, rectangle)) <= 1:
            odds = float(np.log(sure / (1.0 - sure))) if sure < 1.0 else np.inf
            found.append(FrontPanel(rectangle, handles, odds))
    return tuple(found)


def _patches(sight: Sight) -> list[_SeenPatch]:
    ends = np.maximum(sight.level, sight.upright)
    number, count = ndimage.label((sight.panel > LIKELY) & (ends < LIKELY))
    sizes = np.bincount(number.ravel(), minlength=count + 1)
    found = []
    for label, (rows, columns) in enumerate(ndimage.find_objects(number), start=1):
        if sizes[label] < LEAST_SQUARES:
            continue
        low = np.array([rows.start, columns.start])
        high = np.array([rows.stop, columns.stop])
        found.append(_SeenPatch(low, high, float(sizes[label] / (high - low).prod())))
    return found


def _ends(sight: Sight, patch: _SeenPatch) -> FloatArray:
    """How surely it ends at the bottom, top, left and right, 0 to 1, shape [4]."""
    bottom, left = patch.low.tolist()
    top, right = patch.high.tolist()
    level = np.pad(sight.level[:, left:right], ((2, 2), (0, 0)))
    upright = np.pad(sight.upright[bottom:top], ((0, 0), (2, 2)))
    # Padded by two, so that the square before the first is the second of three.
    return np.array(
        [
            level[bottom : bottom + 3].max(axis=0).mean(),
            level[top + 1 : top + 4].max(axis=0).mean(),
            upright[:, left : left + 3].max(axis=1).mean(),
            upright[:, right + 1 : right + 4].max(axis=1).mean(),
        ]
    )


def _rectangle(patch: _SeenPatch, sides: FloatArray, shape: tuple[int, int]) -> Rectangle:
    """To the middle of its ends."""
    low = np.maximum(SQUARE * (patch.low - 1), 0)
    high = np.minimum(SQUARE * (patch.high + 1), np.array(shape) - 1)
    return Rectangle(low, high, sides, sides)
