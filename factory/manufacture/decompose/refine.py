"""Hulls of a solid that take other parts' room, or fill too much, are split more finely."""

from __future__ import annotations

from dataclasses import replace

from manifold3d import Manifold

from ...asset import Hull
from ...config import DecomposeConfig
from .methods import FAITHFUL, SolidPieces, slot_of, split_solid
from .pockets import fills_little
from .room import Room
from .solids import LEAST_VOLUME_M3, manifold_of_hull
from .winding import inside

#: No solid is split more finely than to this share of the least error.
FINEST_SHARE = 0.5
#: Hulls of one solid that are split again at most, in each round.
MOST_REFINED = 16
#: And none once CoACD and V-HACD made so many pieces of the solid: each takes them 0.1 to 0.3 s.
MOST_SEARCHED = 64


def refined(
    solid: Manifold, split: SolidPieces, error_m: float, config: DecomposeConfig, room: Room
) -> SolidPieces:
    """Return the same pieces, with those that cannot stay split again with half the error.

    Args:
        solid: a closed manifold [m].
        split: it in pieces.
        error_m: deepest dent that they were allowed to fill [m].
        config: the least error, and everything else.
        room: that other parts take; where the solid itself lies in it, nothing helps.
    """
    finer = error_m / 2.0
    if split.exact or finer < FINEST_SHARE * config.error_m:
        return split
    bad = [hull for hull in split.hulls if not _may_stay(hull, solid, error_m, config, room)]
    if not bad:
        return split
    again = {id(hull) for hull in bad[:MOST_REFINED]}
    hulls: list[Hull] = []
    method = split.method
    degraded = list(split.degraded)
    searched = split.searched
    for hull in split.hulls:
        if id(hull) not in again or searched >= MOST_SEARCHED:
            hulls.append(hull)
            continue
        for piece in (solid ^ manifold_of_hull(hull)).decompose():
            if piece.volume() <= LEAST_VOLUME_M3:
                continue
            part = split_solid(piece, finer, config)
            part = refined(
                piece, replace(part, searched=searched + part.searched), finer, config, room
            )
            searched = part.searched
            hulls += part.hulls
            method = max(method, part.method, key=FAITHFUL.index)
            degraded += part.degraded
    return SolidPieces(tuple(hulls), method, False, tuple(degraded), searched)


def _may_stay(
    hull: Hull, solid: Manifold, error_m: float, config: DecomposeConfig, room: Room
) -> bool:
    if error_m > config.error_m and not fills_little(hull, solid, error_m, slot_of(config)):
        return False
    taken = room.inside(hull)
    return bool(inside(solid, taken).all())
