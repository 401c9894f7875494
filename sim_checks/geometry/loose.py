"""Small loose pieces of a part's visible surface that lie at another part: stray labels."""

from __future__ import annotations

import numpy as np

from .collision import Skin
from .gaps import visible_gap
from .placing import box_around, grow_box, placed
from .surfaces import PosedSurface, SurfaceMeeting, VisibleSurface, patches

#: A piece with less than this share of its part's area is small.
SMALL_SHARE = 0.05
#: Pairs of faces that are asked which pieces meet.
MET_FACES = 1000

#: The surfaces of two parts, first of the one whose hull is first.
Sides = tuple[PosedSurface, PosedSurface]


def strayed(met: Sides, meeting: SurfaceMeeting, at_rest: Sides, allowed: float) -> bool:
    """Return whether small pieces of one part alone make the two surfaces meet.

    Such pieces lie nearer the other part than their own.

    Args:
        met: the two surfaces where they meet.
        meeting: where the hulls meet.
        at_rest: the same surfaces at rest, where a piece is held against both.
        allowed: depth that counts as clean [m].
    """
    here, there = patches(*met, meeting)
    if here is None or there is None:
        return False
    pairs = here.skin.touching(there.skin, MET_FACES)
    found = (here, there)

    def side_strayed(side: int) -> bool:
        own = met[side].surface
        pieces = np.unique(own.pieces[found[side].rows[pairs[:, side]]])
        areas = np.bincount(own.pieces, weights=own.areas)
        small = pieces[areas[pieces] < SMALL_SHARE * areas.sum()]
        stray = np.isin(own.pieces, small)
        if stray.all() or not stray.any():
            return False
        remains = VisibleSurface(own.vertices, own.faces[~stray])
        left = PosedSurface(remains, met[side].pose)
        one, other = (left, met[1]) if side == 0 else (met[0], left)
        if visible_gap(one, other, meeting) < -allowed:
            return False
        rest = PosedSurface(remains, at_rest[side].pose)
        strays = (VisibleSurface(own.vertices, own.faces[own.pieces == piece]) for piece in small)
        return all(_nearer(stray, at_rest[1 - side], rest, meeting.margin) for stray in strays)

    return any(side_strayed(side) for side in (0, 1))


def _nearer(piece: VisibleSurface, other: PosedSurface, own: PosedSurface, margin: float) -> bool:
    """Return whether a piece lies nearer another part than the rest of its own, posed as that is.

    Gaps beyond ``margin`` [m] are equal.
    """
    vertices = placed(piece.vertices, own.pose)
    skin = Skin(vertices, piece.faces)
    around = grow_box(box_around([vertices[piece.faces]]), margin)

    def gap(surface: PosedSurface) -> float:
        beside = surface.patch(around)
        return margin if beside is None else min(margin, skin.distance(beside.skin))

    return gap(other) < gap(own)
