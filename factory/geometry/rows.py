"""Equal rows of a table, and points that are as good as equal."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ..mesh import FloatArray, IntArray


def distinct_rows(rows: npt.NDArray[np.generic]) -> tuple[IntArray, IntArray]:
    """Find equal rows, as ``np.unique(rows, axis=0)`` does, in a quarter of its time.

    Args:
        rows: shape [n, k].

    Returns:
        Indices of the first of each, in the order of what they hold, shape [m]; and which of these
        every row equals, shape [n].
    """
    order = np.lexsort(rows.T[::-1])
    ordered = rows[order]
    is_new = np.ones(len(rows), dtype=bool)
    is_new[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    which = np.empty(len(rows), dtype=np.int64)
    which[order] = np.cumsum(is_new) - 1
    return np.asarray(order[is_new]), which


def weld_points(points: FloatArray, low: FloatArray, step: float) -> tuple[IntArray, IntArray]:
    """Find points that lie at the same place of a grid; returns what :func:`distinct_rows` does.

    Args:
        points: shape [n, 3].
        low: their least coordinates, where the grid begins, shape [3].
        step: the grid's, at least a hundred-millionth of their extent.
    """
    cells = np.rint((points - low) / step).astype(np.int64)
    # A coordinate has at most 1e8 steps, 27 bits: two of them fit one sort key.
    return distinct_rows(np.column_stack([(cells[:, 0] << 28) | cells[:, 1], cells[:, 2]]))


def number_by_appearance(first: IntArray, which: IntArray) -> tuple[IntArray, IntArray]:
    """Return what :func:`distinct_rows` found in the order of the first ones' places."""
    order = np.argsort(first, kind="stable")
    rank = np.empty(len(first), dtype=np.int64)
    rank[order] = np.arange(len(first))
    return first[order], rank[which]
