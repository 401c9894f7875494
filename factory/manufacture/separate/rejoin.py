"""Pieces that cuts left needlessly apart become one again."""

from __future__ import annotations

from dataclasses import replace
from operator import is_

from ...asset import Hull
from ..decompose.convex import limit_vertices
from ..decompose.decompose import PartHulls
from ..decompose.merge import merge

#: A plane that made room in one corner of a hull cuts through all of it: what is convex again but
#: for this is joined [m].
EXACT_M = 1e-4


def with_hulls(piece: PartHulls, hulls: list[Hull], max_vertices: int) -> PartHulls:
    """Return a part with what cuts left of its hulls.

    Args:
        piece: as it was before.
        hulls: object frame at rest.
        max_vertices: most corners of a hull; a cut adds some, and those that matter least are left
            out again.
    """
    if len(hulls) == len(piece.hulls) and all(map(is_, hulls, piece.hulls)):
        return piece
    if len(hulls) > len(piece.hulls):
        hulls = merge(hulls, EXACT_M)
    limited = tuple(limit_vertices(hull, max_vertices) for hull in hulls)
    return replace(piece, hulls=limited, exact=False)
