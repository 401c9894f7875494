"""Two convex hulls that meet, cut by planes until there is a gap between them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..asset import Hull
from ..decompose.convex import hull_of, planes_of
from ..mesh.mesh import FloatArray


@dataclass(frozen=True)
class Solid:
    """A hull with its planes, ``n . x <= d`` inside, shape [face_count, 4]."""

    hull: Hull
    planes: FloatArray

    @classmethod
    def of(cls, hull: Hull) -> Solid:
        """The hull with its planes."""
        return cls(hull, planes_of(hull))


@dataclass(frozen=True)
class Meeting:
    """How two hulls stand along the face normal that separates them best.

    Attributes:
        direction: unit vector from the first hull towards the second, the first hull's frame, shape [3].
        reach: how far the first reaches beyond the second's start along it [m]; negative is a gap.
        first_end, second_start: their positions along it [m].
    """

    direction: FloatArray
    reach: float
    first_end: float
    second_start: float


def meeting(a: Solid, b: Solid, pose: FloatArray) -> Meeting:
    """The best separating face normal of two hulls, ``b`` moved by ``pose``, shape [4, 4].

    Only face normals are asked, so ``reach`` is an upper bound of the penetration depth. That is enough to
    choose a plane, and any plane between them separates.
    """
    points_b = b.hull.vertices @ pose[:3, :3].T + pose[:3, 3]
    directions = np.vstack([a.planes[:, :3], -b.planes[:, :3] @ pose[:3, :3].T])
    ends = (a.hull.vertices @ directions.T).max(axis=0)
    starts = (points_b @ directions.T).min(axis=0)
    best = int(np.argmin(ends - starts))
    return Meeting(directions[best], float(ends[best] - starts[best]), float(ends[best]), float(starts[best]))


def clipped(hull: Hull, normal: FloatArray, offset: float) -> Hull | None:
    """The part of a hull with ``normal . x <= offset`` [m]; ``None`` if nothing with a volume is left."""
    height = hull.vertices @ normal - offset
    if height.max() <= 0.0:
        return hull
    around = np.concatenate([hull.faces[:, [0, 1]], hull.faces[:, [1, 2]], hull.faces[:, [2, 0]]])
    edges = np.unique(np.sort(around, axis=1), axis=0)
    start, end = height[edges[:, 0]], height[edges[:, 1]]
    crossing = (start < 0.0) != (end < 0.0)
    share = (start / np.where(crossing, start - end, 1.0))[crossing, None]
    first, second = hull.vertices[edges[crossing, 0]], hull.vertices[edges[crossing, 1]]
    return hull_of(np.concatenate([hull.vertices[height <= 0.0], first + share * (second - first)]))
