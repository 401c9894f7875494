"""How one closed solid becomes convex pieces: every method, from the most faithful to the least."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from manifold3d import Manifold

from ...asset import Hull
from ...config import DecomposeConfig
from .cut import as_one, cut_along_faces
from .ladder import search
from .merge import merge
from .pieces import SolidPieces
from .pockets import fills_little
from .room import Room
from .simplify import simplified
from .solids import LEAST_VOLUME_M3, inside, manifold_of_hull

__all__ = ["METHODS", "SolidPieces", "refined", "slot_of", "split_solid"]

#: Exact pieces that are kept as they are; more are joined where that fills little.
FEW_PIECES = 32
#: Pieces that cutting along faces may leave of one solid before CoACD is asked instead.
MOST_CUTS = 96
#: How far the surface may move when a solid is simplified, as a share of the error.
SMOOTHING_SHARE = 0.1
#: No solid is split more finely than to this share of the least error.
FINEST_SHARE = 0.5
#: Hulls of one solid that are split again at most, in each round.
MOST_REFINED = 16
#: And none once CoACD and V-HACD made so many pieces of the solid: each takes them 0.1 to 0.3 s.
MOST_SEARCHED = 64

Method = Callable[[Manifold, float, DecomposeConfig], SolidPieces | None]


def slot_of(config: DecomposeConfig) -> float:
    """Return the width of slots that a hull may fill [m], however far it may be off elsewhere."""
    return 2.0 * config.error_m


def whole(solid: Manifold, error_m: float, config: DecomposeConfig) -> SolidPieces | None:
    """Return one hull, where that fills little."""
    return as_one(solid, error_m, slot_of(config))


def along_faces(solid: Manifold, error_m: float, config: DecomposeConfig) -> SolidPieces | None:
    """Return a few pieces, cut along the solid's own faces."""
    return cut_along_faces(solid, error_m, FEW_PIECES, slot_of(config))


def along_simplified_faces(
    solid: Manifold, error_m: float, config: DecomposeConfig
) -> SolidPieces | None:
    """Return more pieces, cut along the faces of a smoother solid and joined again."""
    light = simplified(solid, config.max_faces, SMOOTHING_SHARE * error_m)
    cut = cut_along_faces(light, error_m, MOST_CUTS, slot_of(config))
    if cut is None:
        return None
    return SolidPieces(tuple(merge(list(cut.hulls), error_m, slot_of(config))), "cut")


def by_search(solid: Manifold, error_m: float, config: DecomposeConfig) -> SolidPieces:
    """Return the pieces of CoACD, else V-HACD, else one hull, joined; see :mod:`.ladder`."""
    found = search(solid, error_m, config)
    return replace(found, hulls=tuple(merge(list(found.hulls), error_m, slot_of(config))))


#: Every method, in the order in which they are tried; the last always has an answer.
METHODS: tuple[Method, ...] = (whole, along_faces, along_simplified_faces, by_search)


def split_solid(solid: Manifold, error_m: float, config: DecomposeConfig) -> SolidPieces:
    """Return the convex pieces of a closed manifold [m] by the first method that has some.

    No dent that a hull fills is deeper than ``error_m`` [m].
    """
    found = (method(solid, error_m, config) for method in METHODS)
    return next(split for split in found if split is not None)


def refined(
    solid: Manifold, split: SolidPieces, error_m: float, config: DecomposeConfig, room: Room
) -> SolidPieces:
    """Return the same pieces, with those that cannot stay split again with half the error.

    Those take other parts' room, or fill more than the least error where slots are; where the solid
    itself lies in that room, nothing helps.
    """
    finer = error_m / 2.0
    if split.exact or finer < FINEST_SHARE * config.error_m:
        return split
    bad = [hull for hull in split.hulls if not _may_stay(hull, solid, error_m, config, room)]
    again = {id(hull) for hull in bad[:MOST_REFINED]}
    found = replace(split, hulls=())
    for hull in split.hulls:
        if id(hull) not in again or found.searched >= MOST_SEARCHED:
            found = replace(found, hulls=(*found.hulls, hull))
            continue
        for piece in (solid ^ manifold_of_hull(hull)).decompose():
            if piece.volume() <= LEAST_VOLUME_M3:
                continue
            part = split_solid(piece, finer, config)
            part = replace(part, searched=found.searched + part.searched)
            part = refined(piece, part, finer, config, room)
            found = replace(found + part, searched=part.searched)
    return found


def _may_stay(
    hull: Hull, solid: Manifold, error_m: float, config: DecomposeConfig, room: Room
) -> bool:
    """Tell whether a hull fills little enough, and no room of others that the solid leaves."""
    if error_m > config.error_m and not fills_little(hull, solid, error_m, slot_of(config)):
        return False
    taken = room.inside(hull)
    return bool(inside(solid, taken).all())
