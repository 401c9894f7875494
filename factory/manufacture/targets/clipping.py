"""Triangles cut to boxes, exactly."""

from __future__ import annotations

import numpy as np

from ...mesh import FloatArray


def clipped(triangles: FloatArray, low: FloatArray, high: FloatArray) -> FloatArray:
    """What of some triangles is in an axis-aligned box (Sutherland and Hodgman 1974, by plane).

    Args:
        triangles: shape [triangle_count, 3, 3].
        low: the box's lower corner, shape [3].
        high: its upper corner.

    Returns:
        Triangles that cover the same surface inside the box, shape [any, 3, 3].
    """
    rest = triangles
    for axis in range(3):
        for sign, bound in ((1.0, low[axis]), (-1.0, high[axis])):
            if not len(rest):
                return rest
            rest = _cut(rest, sign * (rest[:, :, axis] - bound))
    return rest


def _cut(triangles: FloatArray, side: FloatArray) -> FloatArray:
    """The part of each triangle where ``side`` (per corner, linear between) is not negative."""
    kept = side >= 0.0
    count = kept.sum(axis=1)
    if count.min() == 3:
        return triangles
    pieces = [triangles[count == 3]]
    for inside in (1, 2):
        chosen = np.flatnonzero(count == inside)
        if not len(chosen):
            continue
        # The odd corner first: the one kept, or the one cut off.
        odd = (kept[chosen] if inside == 1 else ~kept[chosen]).argmax(axis=1)
        order = (odd[:, None] + np.arange(3)) % 3
        corners = triangles[chosen[:, None], order]
        value = side[chosen[:, None], order]
        share = value[:, :1] / (value[:, :1] - value[:, 1:])
        cuts = corners[:, :1] + share[:, :, None] * (corners[:, 1:] - corners[:, :1])
        if inside == 1:
            corners[:, 1:] = cuts
            pieces.append(corners)
        else:
            other = corners.copy()
            corners[:, 0] = cuts[:, 0]
            other[:, 0] = cuts[:, 0]
            other[:, 1] = corners[:, 2]
            other[:, 2] = cuts[:, 1]
            pieces += [corners, other]
    return np.concatenate(pieces)
