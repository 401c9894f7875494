"""Pieces stretched to a part's visible surface outside all of them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...asset import Hull
from ...mesh import BoolArray, FloatArray
from ..decompose.convex import hull_of, limit_vertices
from ..decompose.outside import outside
from .box import Box
from .matter import Matter
from .pieces import MOST_CORNERS, convex_pieces, filled
from .work import Workpiece

#: What is seen may lie so far outside all pieces [m].
FAR_M = 0.006
#: Points that one piece is stretched to at most.
MOST_POINTS = 40


def covering(
    work: Workpiece,
    part: int,
    cells: BoolArray,
    points: FloatArray,
    most: int,
    whole: BoolArray | None = None,
) -> tuple[Hull, ...]:
    """Return at most ``most`` pieces of a part's cells, stretched to its surface.

    Cells that must stay free of the part are left out; points of its surface have shape [n, 3] [m].
    ``whole`` are the cells within the mesh, where those before a panel's face are not.
    """
    blocked = work.blocked(part)
    whole = work.whole if whole is None else whole
    matter = Matter(work.lattice, cells & (blocked == 0), whole, blocked, points)
    return reaching(matter, convex_pieces(matter, most))


def reaching(matter: Matter, hulls: Sequence[Hull]) -> tuple[Hull, ...]:
    """Stretch pieces of matter where that fills next to nothing that must stay free or is air."""
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
    span = matter.lattice.span(Box(*hull.bounds).grown(0.5 * matter.lattice.step))
    return filled(matter.lattice, matter.unwanted, span, hull)
