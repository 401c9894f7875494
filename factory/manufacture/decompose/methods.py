"""How one closed solid becomes convex pieces: every method, from the most faithful to the least."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import replace

from manifold3d import Manifold

from ...asset import Hull
from ...config import DecomposeConfig
from .cut import as_one, cut_along_faces
from .ladder import search
from .pieces import NOTHING, SolidPieces
from .pockets import fills_little, slot_of
from .room import Room
from .simplify import smoothed
from .solids import LEAST_VOLUME_M3, inside, manifold_of_hull

__all__ = ["METHODS", "SolidPieces", "split_closely", "split_solid"]

#: Pieces that cutting along faces may leave of one solid before CoACD is asked instead.
MOST_CUTS = 96
#: No solid is split more finely than to this share of the least error.
FINEST_SHARE = 0.5
#: Hulls of one solid that are split again at most: a search for pieces of one takes seconds.
MOST_AGAIN = 32

Method = Callable[[Manifold, float, DecomposeConfig], SolidPieces | None]


def along_simplified_faces(
    solid: Manifold, error_m: float, config: DecomposeConfig
) -> SolidPieces | None:
    """Return more pieces, cut along the faces of a smoother solid."""
    light = smoothed(solid, error_m, config)
    cut = cut_along_faces(light, error_m, config, MOST_CUTS)
    return None if cut is None else replace(cut, method="cut")


#: Every method, in the order in which they are tried; the last always has an answer.
METHODS: tuple[Method, ...] = (as_one, cut_along_faces, along_simplified_faces, search)


def split_solid(solid: Manifold, error_m: float, config: DecomposeConfig) -> SolidPieces:
    """Return the convex pieces of a closed manifold [m] by the first method that has some.

    No dent that a hull fills is deeper than ``error_m`` [m].
    """
    found = (method(solid, error_m, config) for method in METHODS)
    return next(split for split in found if split is not None)


def split_closely(
    solid: Manifold, error_m: float, config: DecomposeConfig, room: Room
) -> SolidPieces:
    """Return the convex pieces of a closed manifold, those that cannot stay split again.

    Those take other parts' room, or fill more than the least error where slots are: they are split
    with half the error, and so on. Where the solid itself lies in that room, nothing helps. Halves
    are as fine as may be.
    """
    found = NOTHING
    waiting = deque([(solid, error_m)])
    again = 0
    while waiting:
        piece, error_m = waiting.popleft()
        split = split_solid(piece, error_m, config)
        finer = error_m / 2.0
        final = split.method in ("exact", "halved") or finer < FINEST_SHARE * config.error_m
        kept = []
        for hull in split.hulls:
            if final or again >= MOST_AGAIN or _may_stay(hull, piece, error_m, config, room):
                kept.append(hull)
                continue
            again += 1
            within = (piece ^ manifold_of_hull(hull)).decompose()
            waiting += [(part, finer) for part in within if part.volume() > LEAST_VOLUME_M3]
        found += replace(split, hulls=tuple(kept))
    return found


def _may_stay(
    hull: Hull, solid: Manifold, error_m: float, config: DecomposeConfig, room: Room
) -> bool:
    """Tell whether a hull fills little enough, and no room of others that the solid leaves."""
    if error_m > config.error_m and not fills_little(hull, solid, error_m, slot_of(config)):
        return False
    taken = room.inside(hull)
    return bool(inside(solid, taken).all())
