"""Convex pieces of a solid by planes across it: coarse, and never less than the solid."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from manifold3d import Manifold

from ...asset import Hull
from .convex import hull_of
from .cut import halves_of, waste_of
from .solids import triangles_of

#: Where planes are tried, as shares of a piece's extents.
PLACES = (0.25, 0.5, 0.75)


def halve(solid: Manifold, outside_m: float, most: int) -> list[Hull]:
    """Return hulls that together cover a solid, cut in two where a hull stands out of it most.

    Each piece is cut by the plane across one of its box's axes that saves the most volume, until
    the hulls lie ``outside_m`` outside on average over the solid's surface [m], or are ``most``.
    """
    pieces = [(waste_of([piece]), piece) for piece in solid.decompose()]
    enough = outside_m * solid.surface_area()
    while 0 < len(pieces) < most and sum(waste for waste, _ in pieces) > enough:
        worst = max(range(len(pieces)), key=lambda index: pieces[index][0])
        best = min(_cuts(pieces.pop(worst)[1]), key=waste_of)
        pieces += [(waste_of([piece]), piece) for piece in best]
    hulls = (hull_of(triangles_of(piece)[0]) for _, piece in pieces)
    return [hull for hull in hulls if hull is not None]


def _cuts(solid: Manifold) -> Iterator[list[Manifold]]:
    """Yield the pieces that each of the planes makes of a solid."""
    low, high = np.array(solid.bounding_box()).reshape(2, 3)
    for axis, normal in enumerate(np.eye(3)):
        for share in PLACES:
            yield halves_of(solid, normal, float(low[axis] + share * (high[axis] - low[axis])))
