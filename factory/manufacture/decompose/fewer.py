"""An asset of many hulls gets fewer, further off the surfaces they stand for."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from ...config import BuildConfig
from ...runtime.keys import Stage
from ...runtime.packing import contents
from ...runtime.store import Store
from .convex import limit_vertices
from .decompose import recalled
from .merge import merge
from .methods import slot_of
from .pieces import SolidPieces
from .room import NOWHERE, Room, Rooms

FEWER = Stage(
    "fewer",
    code=(__name__,),
    settings=("decompose.error_m", "decompose.max_vertices"),
    libraries=("manifold3d", "scipy"),
)
#: Multiples of the error that are tried, one after another, until there are few enough.
COARSER = (1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0)
#: Up to this multiple slots stay as open as the decomposition left them.
GENTLE = 2.0
#: Parts of fewer hulls than this are left as they are.
FEW = 8


def fewer(
    pieces: tuple[SolidPieces, ...],
    config: BuildConfig,
    store: Store | None = None,
    rooms: Rooms | None = None,
) -> tuple[tuple[SolidPieces, ...], dict[int, float]]:
    """Join the hulls of parts, those of most hulls first, until all together are few enough.

    Where even the largest error leaves more, the asset keeps those.

    Args:
        pieces: hulls per part.
        config: how many there may be, and of the decomposition.
        store: results are kept here by content; without it everything is computed anew.
        rooms: what others take of each part's: no joined hull takes more of it.

    Returns:
        The parts, and the error [m] of each one that was joined, by its index.
    """
    joined = list(pieces)
    errors_m: dict[int, float] = {}
    many = sorted(range(len(pieces)), key=lambda part: -len(pieces[part].hulls))
    for times in (each for each in COARSER if each <= config.hulls.coarsest):
        most = config.hulls.wanted if times <= config.hulls.coarse else config.hulls.most
        for part in many:
            if sum(len(piece.hulls) for piece in joined) <= most:
                return tuple(joined), errors_m
            if len(pieces[part].hulls) >= FEW:
                error_m = times * config.decompose.error_m
                room = rooms.around(part) if rooms else NOWHERE
                key = FEWER.key(config, *contents(pieces[part]), error_m, room.points)
                make = partial(_joined, pieces[part], error_m, config, room)
                joined[part] = recalled(store, key, make)
                if len(joined[part].hulls) < len(pieces[part].hulls):
                    errors_m[part] = error_m
    return tuple(joined), errors_m


def _joined(piece: SolidPieces, error_m: float, config: BuildConfig, room: Room) -> SolidPieces:
    """Return one part with its hulls joined, up to an error [m]; itself where none can be."""
    slot_m = slot_of(config.decompose) if error_m <= GENTLE * config.decompose.error_m else None
    merged = merge(list(piece.hulls), error_m, slot_m, room)
    if len(merged) == len(piece.hulls):
        return piece
    hulls = tuple(limit_vertices(hull, config.decompose.max_vertices) for hull in merged)
    return replace(piece, hulls=hulls)
