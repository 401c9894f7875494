"""Convex pieces of a solid by planes across it: coarse, and never less than the solid."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from manifold3d import Manifold

from ...asset import Hull
from .convex import hull_of
from .solids import manifold_of_hull, triangles_of

#: Where planes are tried, as shares of a piece's extents.
PLACES = (0.25, 0.5, 0.75)


@dataclass(frozen=True, eq=False)
class _Piece:
    """A connected piece of a solid, its hull, and the volume that this fills in vain [m3]."""

    solid: Manifold
    hull: Hull
    excess: float


def halve(solid: Manifold, outside_m: float, most: int) -> list[Hull]:
    """Return hulls that together cover a solid, cut in two where a hull stands out of it most.

    Each piece is cut by the plane across one of its box's axes that saves the most volume, until
    the hulls lie ``outside_m`` outside on average over the solid's surface [m], or are ``most``.
    """
    pieces = list(_pieces(solid))
    enough = outside_m * solid.surface_area()
    while 0 < len(pieces) < most and sum(piece.excess for piece in pieces) > enough:
        worst = max(range(len(pieces)), key=lambda index: pieces[index].excess)
        cuts = _cuts(pieces.pop(worst).solid)
        pieces += min(cuts, key=lambda parts: sum(part.excess for part in parts))
    return [piece.hull for piece in pieces]


def _cuts(solid: Manifold) -> Iterator[list[_Piece]]:
    """Yield the pieces that each of the planes makes of a solid."""
    low, high = np.array(solid.bounding_box()).reshape(2, 3)
    for axis, normal in enumerate(np.eye(3)):
        for share in PLACES:
            at = float(low[axis] + share * (high[axis] - low[axis]))
            yield [piece for half in solid.split_by_plane(normal, at) for piece in _pieces(half)]


def _pieces(solid: Manifold) -> Iterator[_Piece]:
    for part in solid.decompose():
        hull = hull_of(triangles_of(part)[0])
        if hull is not None:
            excess = manifold_of_hull(hull).volume() - part.volume()
            yield _Piece(part, hull, max(excess, 0.0))
