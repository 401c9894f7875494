"""How well the parts of an articulation agree with what the detector sees."""

from __future__ import annotations

import numpy as np

from ...articulation import Articulation
from ...geometry.crossings import BoolArray
from ...geometry.elevations import elevation
from ...geometry.posing import face_parts
from ...mesh import FloatArray, IntArray, Mesh
from ...models.detector.canvas import CANVAS, LONGEST, SIDES, place_of
from ...models.detector.decode import STRIDE, Dense, share_of

#: A part that fewer cells show is not seen.
LEAST_CELLS = 2
_CELLS = (np.arange(CANVAS // STRIDE) + 0.5) * STRIDE


def faces_seen(mesh: Mesh) -> IntArray:
    """Return the nearest face at the middle of every cell of 4 pixels, -1 for none, [5, 64, 64]."""
    cells = len(_CELLS)
    seen = np.full((len(SIDES), cells, cells), -1, dtype=np.int64)
    for number, side in enumerate(SIDES):
        picture = elevation(mesh, side, LONGEST)
        canvas = np.full((CANVAS, CANVAS), -1, dtype=np.int64)
        canvas[place_of(picture)] = picture.face
        seen[number] = canvas[STRIDE // 2 :: STRIDE, STRIDE // 2 :: STRIDE]
    return seen


def support_of(articulation: Articulation, seen: IntArray, dense: Dense) -> tuple[float, ...]:
    """Return the support of the part of each joint, 0 to 1.

    That is the mean over the cells that show it of the probability of its likeliest sort, times how
    well the box that is seen there fits the part's own; on the side where that is highest.

    Args:
        articulation: at rest as it was looked at.
        seen: faces of its mesh, as :func:`faces_seen` has them.
        dense: what the detector says.
    """
    owner = np.append(face_parts(articulation), -1)[seen]
    found = []
    for joint in articulation.joints:
        shown = np.isin(owner, articulation.carried(joint.child))
        found.append(max(_on_side(shown[view], dense, view) for view in range(len(SIDES))))
    return tuple(found)


def _on_side(shown: BoolArray, dense: Dense, view: int) -> float:
    rows, columns = np.nonzero(shown)
    if len(rows) < LEAST_CELLS:
        return 0.0
    low = np.array([columns.min(), rows.min()]) * STRIDE
    high = (np.array([columns.max(), rows.max()]) + 1) * STRIDE
    fits = _fit(dense.edges[view][:, rows, columns], rows, columns, low, high)
    share = share_of(dense.sort[view][:, rows, columns])
    return float((share * fits).mean(axis=1).max())


def _fit(
    edges: FloatArray, rows: IntArray, columns: IntArray, low: IntArray, high: IntArray
) -> FloatArray:
    """Return the intersection over union of the boxes about cells with one box, shape [n]."""
    left, bottom, right, top = edges
    x, y = _CELLS[columns], _CELLS[rows]
    wide = np.minimum(x + right, high[0]) - np.maximum(x - left, low[0])
    tall = np.minimum(y + top, high[1]) - np.maximum(y - bottom, low[1])
    inner = np.maximum(wide, 0.0) * np.maximum(tall, 0.0)
    union = (left + right) * (bottom + top) + float(np.prod(high - low)) - inner
    return np.asarray(inner / np.maximum(union, 1.0))
