"""Convex pieces of solids and parts, and how faithful they are to them."""

from __future__ import annotations

from dataclasses import dataclass

from ...asset import Hull

#: How faithful pieces are, from the most to the least; a part is named after its least faithful.
FAITHFUL = ("exact", "cut", "single", "sheets", "coacd", "halved", "hull")


@dataclass(frozen=True)
class SolidPieces:
    """Convex pieces of one solid, of several, or of a part: its collision geometry.

    Attributes:
        hulls: that together cover it, object frame at rest; none where it is too thin for a body,
            nor of a carrier.
        method: the farthest any of its pieces had to go: ``none`` (carrier), ``exact``, ``cut``
            (along its own faces), ``single`` (one hull that fills only small dents), ``sheets``
            (slabs over open surfaces), ``coacd``, ``halved`` (by planes across it), ``hull`` (one
            hull, convex or not); ``built`` (made from a one-piece mesh).
        degraded: one sentence for each thing given up on the way; empty when all went well.
    """

    hulls: tuple[Hull, ...]
    method: str
    degraded: tuple[str, ...] = ()

    def __add__(self, other: SolidPieces) -> SolidPieces:
        """Return the pieces of both, named after the less faithful."""
        return SolidPieces(
            self.hulls + other.hulls,
            max(self.method, other.method, key=FAITHFUL.index),
            self.degraded + other.degraded,
        )


#: Pieces of nothing.
NOTHING = SolidPieces((), "exact")
