"""From the detector's dense answers to parts: boxes on sides, each with what it is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.special import expit, softmax

from ...mesh import FloatArray, IntArray
from ...views.raster import Side
from .canvas import SIDES, SORTS, STRIDE, Sort

#: Boxes that share more than this of their union are one.
SAME = 0.45
#: Parts that are told of one side.
MOST_PARTS = 100


@dataclass(frozen=True, eq=False)
class Dense:
    """What the network says: of a batch of n objects as tensors, of one as arrays without n.

    Dense answers are per stride of 4 pixels, [n, 5, ..., 64, 64].

    Attributes:
        sort: log-odds of each sort of part.
        edges: distances to the left, lower, right and upper edge of the part there [pixels].
        way: log-odds of each way to open.
        quality: log-odds of how well the box fits.
        opened: share of its range by which it stands open.
        kind: log-odds of kinds of object, [n, kinds].
        opens: log-odds that anything opens, [n].
        front: log-odds of each upright side that it is the front, [n, 4].
    """

    sort: Any
    edges: Any
    way: Any
    quality: Any
    opened: Any
    kind: Any
    opens: Any
    front: Any


@dataclass(frozen=True, eq=False)
class Found:
    """One part as seen on one side.

    Attributes:
        side: where.
        box: left, lower, right, upper edge [pixels of the canvas], shape [4].
        sort: the likeliest.
        score: that there is such a part there, 0 to 1.
        ways: probability of each way to open, shape [way_count].
    """

    side: Side
    box: FloatArray
    sort: Sort
    score: float
    ways: FloatArray


def found_parts(dense: Dense, least: float) -> tuple[Found, ...]:
    """Return parts with a score of at least ``least``, the surest of each side first."""
    return tuple(each for view in range(len(SIDES)) for each in _on_side(dense, view, least))


def _on_side(dense: Dense, view: int, least: float) -> list[Found]:
    share = expit(dense.sort[view])
    score = np.sqrt(share.max(axis=0) * expit(dense.quality[view]))
    rows, columns = np.nonzero(score >= least)
    left = np.argsort(-score[rows, columns], kind="stable")
    boxes = _boxes(dense.edges[view], rows, columns)
    found: list[Found] = []
    while len(left) and len(found) < MOST_PARTS:
        best = left[0]
        left = left[overlaps(boxes[best], boxes[left]) <= SAME]
        left = left[left != best]
        row = rows[best]
        column = columns[best]
        found.append(
            Found(
                SIDES[view],
                boxes[best],
                SORTS[int(share[:, row, column].argmax())],
                float(score[row, column]),
                softmax(dense.way[view, :, row, column]),
            )
        )
    return found


def _boxes(edges: FloatArray, rows: IntArray, columns: IntArray) -> FloatArray:
    """Return the boxes about cells, shape [n, 4]."""
    x = (columns + 0.5) * STRIDE
    y = (rows + 0.5) * STRIDE
    left, low, right, high = edges[:, rows, columns]
    return np.stack([x - left, y - low, x + right, y + high], axis=1)


def overlaps(box: FloatArray, boxes: FloatArray) -> FloatArray:
    """Return the intersection over union of a box with others, shape [n]."""
    inner = shared_areas(box, boxes)
    areas = np.prod(boxes[:, 2:] - boxes[:, :2], axis=1)
    own = float(np.prod(box[2:] - box[:2]))
    return np.asarray(inner / np.maximum(areas + own - inner, 1e-9))


def shared_areas(box: FloatArray, boxes: FloatArray) -> FloatArray:
    """Return the areas that a box shares with others, shape [n]."""
    low = np.maximum(box[:2], boxes[:, :2])
    high = np.minimum(box[2:], boxes[:, 2:])
    return np.asarray(np.prod(np.maximum(high - low, 0.0), axis=1))
