"""Triangles cut along planes: into pieces that keep what their corners had."""

from dataclasses import dataclass

import numpy as np

from ..mesh import BoolArray, FloatArray, IntArray
from .triangles import FOLLOWING, ends_of

#: Corners 0 to 2 are a triangle's own, 3 to 5 lie on its edges 0-1, 1-2 and 2-0; -1: no piece. By
#: the edges that are divided: 1, 2 and 4, added up.
_NONE = (-1, -1, -1)
_PIECES = np.array(
    [
        ((0, 1, 2), _NONE, _NONE, _NONE),
        ((0, 3, 2), (3, 1, 2), _NONE, _NONE),
        ((1, 4, 0), (4, 2, 0), _NONE, _NONE),
        ((1, 4, 3), (4, 2, 0), (4, 0, 3), _NONE),
        ((2, 5, 1), (5, 0, 1), _NONE, _NONE),
        ((0, 3, 5), (3, 1, 2), (3, 2, 5), _NONE),
        ((2, 5, 4), (5, 0, 1), (5, 1, 4), _NONE),
        ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)),
    ]
)


@dataclass(frozen=True, eq=False)
class Pieces:
    """Pieces of triangles, wound as these are.

    Attributes:
        whole: the triangle that each is a piece of, shape [piece_count].
        corner: which corners each has: 0 to 2 are the triangle's own, 3 to 5 lie on its edges 0-1,
            1-2 and 2-0; shape [piece_count, 3].
        share: how far along these edges, 0 to 1, shape [triangle_count, 3].
    """

    whole: IntArray
    corner: IntArray
    share: FloatArray

    def spread(self, values: FloatArray) -> FloatArray:
        """Interpolate what the triangles' corners have for the corners of the pieces.

        Args:
            values: shape [triangle_count, 3, k].

        Returns:
            Shape [piece_count, 3, k].
        """
        between = values + self.share[..., None] * (values[:, FOLLOWING] - values)
        six = np.concatenate([values, between], axis=1)
        return np.asarray(six[self.whole[:, None], self.corner])


def divide(edges: BoolArray, share: FloatArray) -> Pieces:
    """Divide triangles at points of their edges: first pieces first, each in the triangles' order.

    Args:
        edges: which edges are divided: 0-1, 1-2 and 2-0, shape [triangle_count, 3].
        share: how far from the edge's first corner, 0 to 1, shape [triangle_count, 3].
    """
    pieces = _PIECES[edges @ np.array([1, 2, 4])]
    number, whole = np.nonzero(pieces[:, :, 0].T >= 0)
    return Pieces(whole, pieces[whole, number], share)


def cut_at_zero(height: FloatArray) -> Pieces:
    """Cut triangles where a height, linear between their corners, is zero.

    Args:
        height: of every corner, shape [triangle_count, 3], at least one triangle.
    """
    following = height[:, FOLLOWING]
    edges = height * following < 0.0
    share = np.divide(height, height - following, out=np.zeros_like(height), where=edges)
    return divide(edges, share)


def clip_to_box(triangles: FloatArray, low: FloatArray, high: FloatArray) -> FloatArray:
    """Cut triangles to an axis-aligned box.

    Args:
        triangles: corners [m], shape [triangle_count, 3, 3].
        low: the box's lower corner, shape [3].
        high: its upper corner.

    Returns:
        Triangles that cover the same surface inside the box, shape [any, 3, 3].
    """
    for axis in range(3):
        for sign, bound in ((1.0, low[axis]), (-1.0, high[axis])):
            height = sign * (triangles[:, :, axis] - bound)
            least, most = ends_of(height)
            inside = least >= 0.0
            if inside.all():
                continue
            crossing = (least < 0.0) & (most > 0.0)
            kept = triangles[inside]
            if crossing.any():
                pieces = cut_at_zero(height[crossing])
                above = pieces.spread(height[crossing][..., None]).sum(axis=(1, 2)) > 0.0
                kept = np.concatenate([kept, pieces.spread(triangles[crossing])[above]])
            triangles = kept
    return triangles
