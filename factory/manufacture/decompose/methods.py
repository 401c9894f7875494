"""How one closed solid becomes convex pieces: every method, from the most faithful to the least."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from manifold3d import Manifold

from ...asset import Hull
from ...config import DecomposeConfig
from .cut import Cut, as_one, cut_along_faces
from .ladder import climb_down
from .merge import merge
from .simplify import simplified

#: How faithful pieces are, from the most to the least; a part is named after its least faithful.
FAITHFUL = ("exact", "cut", "single", "sheets", "coacd", "vhacd", "hull")
#: Exact pieces that are kept as they are; more are joined where that fills little.
FEW_PIECES = 32
#: Pieces that cutting along faces may leave of one solid before CoACD is asked instead.
MOST_CUTS = 96
#: How far the surface may move when a solid is simplified, as a share of the error.
SMOOTHING_SHARE = 0.1


@dataclass(frozen=True)
class SolidPieces:
    """Convex pieces of one solid.

    Attributes:
        hulls: that together cover it; none where it is too thin for a body.
        method: one of ``FAITHFUL``.
        exact: the hulls are the solid, no more and no less.
        degraded: a sentence for everything given up on the way.
        searched: pieces that CoACD and V-HACD made of it.
    """

    hulls: tuple[Hull, ...]
    method: str
    exact: bool = False
    degraded: tuple[str, ...] = ()
    searched: int = 0


Method = Callable[[Manifold, float, DecomposeConfig], SolidPieces | None]


def slot_of(config: DecomposeConfig) -> float:
    """Width of slots that a hull may fill [m], however far its surface may be off elsewhere."""
    return 2.0 * config.error_m


def whole(solid: Manifold, error_m: float, config: DecomposeConfig) -> SolidPieces | None:
    """Return one hull, where that fills little."""
    return _named(as_one(solid, error_m, slot_of(config)))


def along_faces(solid: Manifold, error_m: float, config: DecomposeConfig) -> SolidPieces | None:
    """Return a few pieces, cut along the solid's own faces."""
    return _named(cut_along_faces(solid, error_m, FEW_PIECES, slot_of(config)))


def along_simplified_faces(
    solid: Manifold, error_m: float, config: DecomposeConfig
) -> SolidPieces | None:
    """More pieces, cut along the faces of a smoother solid and joined again."""
    light = simplified(solid, config.max_faces, SMOOTHING_SHARE * error_m)
    cut = cut_along_faces(light, error_m, MOST_CUTS, slot_of(config))
    if cut is None:
        return None
    return SolidPieces(tuple(merge(list(cut.hulls), error_m, slot_of(config))), "cut")


def by_search(solid: Manifold, error_m: float, config: DecomposeConfig) -> SolidPieces:
    """CoACD, else V-HACD, else one hull; see :mod:`.ladder`."""
    rung = climb_down(solid, error_m, config)
    if rung is None:
        return SolidPieces((), "exact", exact=True)
    hulls = tuple(merge(list(rung.hulls), error_m, slot_of(config)))
    return SolidPieces(hulls, rung.method, degraded=rung.degraded, searched=rung.searched)


#: Every method, in the order in which they are tried; the last always has an answer.
METHODS: tuple[Method, ...] = (whole, along_faces, along_simplified_faces, by_search)


def split_solid(solid: Manifold, error_m: float, config: DecomposeConfig) -> SolidPieces:
    """Return the convex pieces of one closed solid by the first method that has some.

    Args:
        solid: a closed manifold [m].
        error_m: deepest dent that a hull may fill [m].
        config: everything else.
    """
    found = (method(solid, error_m, config) for method in METHODS)
    return next(split for split in found if split is not None)


def _named(cut: Cut | None) -> SolidPieces | None:
    if cut is None:
        return None
    if cut.exact:
        return SolidPieces(cut.hulls, "exact", exact=True)
    return SolidPieces(cut.hulls, "single" if len(cut.hulls) == 1 else "cut")
