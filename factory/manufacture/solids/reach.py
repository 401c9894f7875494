"""Pieces stretched to a part's visible surface outside all of them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...asset import Hull
from ...mesh import FloatArray
from ..decompose.convex import hull_of, limit_vertices
from ..decompose.outside import outside
from .box import Box
from .matter import Matter
from .pieces import MOST_CORNERS, filled

#: What is seen may lie so far outside all pieces [m].
FAR_M = 0.006
#: Points that one piece is stretched to at most.
MOST_POINTS = 40


def reaching(matter: Matter, hulls: Sequence[Hull]) -> tuple[Hull, ...]:
    """Stretch pieces where that fills next to nothing that must stay free or is air.

    Args:
        matter: that they are pieces of.
        hulls: they.
    """
    if not hulls:
        return ()
    points = matter.sparse[outside(hulls, matter.sparse) > FAR_M]
    nearest = np.array([outside([hull], points) for hull in hulls]).argmin(axis=0)
    return tuple(
        _stretched(matter, hull, points[nearest == number]) for number, hull in enumerate(hulls)
    )


def _stretched(matter: Matter, hull: Hull, points: FloatArray) -> Hull:
    filled = _filled(matter, hull)
    distance = outside([hull], points)
    for _ in range(MOST_POINTS):
        far = distance > FAR_M
        points = points[far]
        distance = distance[far]
        if not len(points):
            break
        farthest = int(distance.argmax())
        wider = hull_of(np.concatenate([hull.vertices, points[farthest : farthest + 1]]))
        points = np.delete(points, farthest, axis=0)
        distance = np.delete(distance, farthest)
        if wider is None:
            continue
        wider = limit_vertices(wider, MOST_CORNERS)
        if _filled(matter, wider) <= filled + matter.trifle:
            hull = wider
            distance = outside([hull], points)
    return hull


def _filled(matter: Matter, hull: Hull) -> float:
    """Return what it fills of what must stay free, by weight, and of air [m3]."""
    span = matter.lattice.span(Box.around(hull.vertices).grown(0.5 * matter.lattice.step))
    return filled(matter.lattice, matter.unwanted, span, hull)
