"""An asset of many hulls gets fewer, further off the surfaces they stand for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

from ...config import HullsConfig
from ...runtime.keys import Stage
from ...runtime.packing import contents
from ...runtime.stages import Stages
from .convex import limit_vertices
from .merge import merge
from .pieces import SolidPieces
from .pockets import slot_of
from .room import Room

FEWER = Stage(
    "fewer",
    code=(__name__,),
    settings=("decompose.error_m", "decompose.max_vertices"),
    libraries=("manifold3d", "scipy"),
)
#: Multiples of the error that are tried, one after another, until there are few enough.
COARSER = (1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0)
#: Parts of fewer hulls than this are left as they are.
FEW = 8


def fewer(
    pieces: tuple[SolidPieces, ...],
    wanted: HullsConfig,
    stages: Stages,
    room_of: Callable[[int], Room],
) -> tuple[tuple[SolidPieces, ...], dict[int, float]]:
    """Join the hulls of parts, those of most hulls first, until all together are few enough.

    Where even the largest error leaves more, the asset keeps those.

    Args:
        pieces: hulls per part.
        wanted: how many there may be.
        stages: with the settings and the cache.
        room_of: what others take of each part's: no joined hull takes more of it.

    Returns:
        The parts, and the error [m] of each one that was joined, by its index.
    """
    config = stages.config.decompose
    joined = list(pieces)
    errors_m: dict[int, float] = {}
    many = sorted(range(len(pieces)), key=lambda part: -len(pieces[part].hulls))
    for times in (each for each in COARSER if each <= wanted.coarsest):
        gentle = times <= wanted.coarse
        most = wanted.wanted if gentle else wanted.most
        # Slots stay as open as the decomposition left them while that is asked of any asset.
        slot_m = slot_of(config) if gentle else None
        for part in many:
            if sum(len(piece.hulls) for piece in joined) <= most:
                return tuple(joined), errors_m
            piece = pieces[part]
            if len(piece.hulls) >= FEW:
                error_m = times * config.error_m
                room = room_of(part)
                key = FEWER.key(stages.config, *contents(piece), error_m, slot_m, room.points)
                make = partial(_joined, piece, error_m, slot_m, config.max_vertices, room)
                joined[part] = stages.recall("decompose", SolidPieces, key, make)
                if len(joined[part].hulls) < len(piece.hulls):
                    errors_m[part] = error_m
    return tuple(joined), errors_m


def _joined(
    piece: SolidPieces, error_m: float, slot_m: float | None, max_vertices: int, room: Room
) -> SolidPieces:
    """Return one part with its hulls joined, see ``merge``; itself where none can be."""
    merged = merge(list(piece.hulls), error_m, slot_m, room)
    if len(merged) == len(piece.hulls):
        return piece
    return replace(piece, hulls=tuple(limit_vertices(hull, max_vertices) for hull in merged))
