"""Small loose pieces of a part's visible surface that lie at another part: stray labels."""

from __future__ import annotations

import numpy as np

from ..description import FloatArray, IntArray
from .gaps import visible_gap
from .surfaces import Patch, SurfaceMeeting, VisibleSurface, patch

#: A piece with less than this share of its part's area is small.
SMALL_SHARE = 0.05
#: Pairs of faces that are asked which pieces meet.
MET_FACES = 1000


def strayed(
    found: tuple[Patch, Patch], meeting: SurfaceMeeting, rest: FloatArray, allowed: float
) -> bool:
    """Return whether small pieces of one part alone make the two surfaces meet.

    Such pieces lie nearer the other part than their own.

    Args:
        found: the two surfaces around the meeting.
        meeting: where the hulls meet.
        rest: poses of both parts' frames at rest, where a piece is held against both, shape [2, 4,
            4].
        allowed: depth that counts as clean [m].
    """
    pairs = found[0].skin.touching(found[1].skin, MET_FACES)
    return any(_side_strayed(found, side, pairs, meeting, rest, allowed) for side in (0, 1))


def _side_strayed(
    found: tuple[Patch, Patch],
    side: int,
    pairs: IntArray,
    meeting: SurfaceMeeting,
    rest: FloatArray,
    allowed: float,
) -> bool:
    own = found[side].surface
    other = found[1 - side].surface
    small = _small(own, np.unique(own.pieces[found[side].rows[pairs[:, side]]]))
    rows = np.flatnonzero(np.isin(own.pieces, small))
    remains = own.without(rows) if len(rows) else None
    if remains is None:
        return False
    surfaces = (remains, other) if side == 0 else (other, remains)
    poses = np.array([found[0].pose, found[1].pose])
    if visible_gap(surfaces[0], surfaces[1], poses, meeting) < -allowed:
        return False
    frames = rest[[side, 1 - side]]
    pieces = (np.flatnonzero(own.pieces == piece) for piece in small)
    return all(_nearer(own, rows, remains, other, frames, meeting.margin) for rows in pieces)


def _small(surface: VisibleSurface, pieces: IntArray) -> IntArray:
    areas = np.bincount(surface.pieces, weights=surface.areas)
    small: IntArray = pieces[areas[pieces] < SMALL_SHARE * areas.sum()]
    return small


def _nearer(
    own: VisibleSurface,
    rows: IntArray,
    remains: VisibleSurface,
    other: VisibleSurface,
    poses: FloatArray,
    margin: float,
) -> bool:
    """Return whether a piece lies nearer the other part than the rest of its own part.

    Gaps beyond ``margin`` are equal.
    """
    piece = VisibleSurface(own.vertices, own.faces[rows])
    corners = piece.vertices[np.unique(piece.faces)] @ poses[0, :3, :3].T + poses[0, :3, 3]
    low = corners.min(axis=0) - margin
    high = corners.max(axis=0) + margin
    loose = patch(piece, poses[0], low, high)
    gaps = []
    for surface, pose in ((remains, poses[0]), (other, poses[1])):
        beside = patch(surface, pose, low, high)
        gap = margin
        if loose is not None and beside is not None:
            gap = min(margin, loose.skin.distance(beside.skin))
        gaps.append(gap)
    return gaps[1] < gaps[0]
