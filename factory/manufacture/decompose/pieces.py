"""Convex pieces of a solid, and how faithful they are to it."""

from __future__ import annotations

from dataclasses import dataclass

from ...asset import Hull

#: How faithful pieces are, from the most to the least; a part is named after its least faithful.
FAITHFUL = ("exact", "cut", "single", "sheets", "coacd", "vhacd", "hull")


@dataclass(frozen=True)
class SolidPieces:
    """Convex pieces of one solid, or of several.

    Attributes:
        hulls: that together cover it; none where it is too thin for a body.
        method: one of ``FAITHFUL``.
        exact: the hulls are the solid, no more and no less.
        degraded: a sentence for everything given up on the way.
        searched: pieces that CoACD and V-HACD made of it, failed attempts included: what their
            time goes by.
    """

    hulls: tuple[Hull, ...]
    method: str
    exact: bool = False
    degraded: tuple[str, ...] = ()
    searched: int = 0

    def __add__(self, other: SolidPieces) -> SolidPieces:
        """Return the pieces of both, named after the less faithful."""
        return SolidPieces(
            self.hulls + other.hulls,
            max(self.method, other.method, key=FAITHFUL.index),
            self.exact and other.exact,
            self.degraded + other.degraded,
            self.searched + other.searched,
        )


#: Pieces of nothing.
NOTHING = SolidPieces((), "exact", exact=True)
