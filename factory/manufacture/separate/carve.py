"""A convex hull in a few pieces around the room that something else takes."""

from __future__ import annotations

import numpy as np

from ...asset import Hull
from ...mesh import FloatArray
from ..decompose.convex import hull_of
from .clip import clipped, volumes_below

#: Most pieces that are kept of one hull.
MOST_PIECES = 4
#: Of the room's planes those that leave most of the hull outside, by its farthest corner.
PLANES_TRIED = 8
#: Pieces of less than this share of the hull, or thinner than this [m], are splinters.
SPLINTER_SHARE = 0.01
SPLINTER_M = 0.002


def carved(
    solid: Hull,
    room: FloatArray,
    clearance_m: float,
    most: int = MOST_PIECES,
    least_m3: float | None = None,
) -> list[Hull]:
    """Return what is left of a hull outside some room, as convex pieces.

    Piece by piece the largest that one plane of the room leaves outside is kept.

    Args:
        solid: the hull.
        room: points whose convex hull is to be free [m], shape [n, 3].
        clearance_m: to be left around it [m].
        most: pieces that are kept.
        least_m3: smaller pieces are splinters [m3]; otherwise a share of the hull.
    """
    around = hull_of(room)
    if around is None:
        return []
    planes = around.planes.copy()
    planes[:, 3] += clearance_m
    least = SPLINTER_SHARE * solid.volume if least_m3 is None else least_m3
    kept: list[Hull] = []
    rest: Hull | None = solid
    while rest is not None and len(kept) < most:
        heights = (rest.vertices @ planes[:, :3].T).max(axis=0) - planes[:, 3]
        tried = np.argsort(-heights, kind="stable")[:PLANES_TRIED]
        tried = tried[heights[tried] > SPLINTER_M]
        outside = volumes_below(rest, -planes[tried, :3], -planes[tried, 3])
        if not (outside >= least).any():
            break
        plane = int(tried[outside.argmax()])
        piece = clipped(rest, -planes[plane, :3], -float(planes[plane, 3]))
        if piece is None:
            break
        kept.append(piece)
        rest = clipped(rest, planes[plane, :3], float(planes[plane, 3]))
    return kept
