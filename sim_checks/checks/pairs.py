"""Pairs of solids: how they stand at rest, which are exempt, and where they meet."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property

from ..config import PenetrationConfig
from ..geometry.depth import HullOverlap, contact_region
from ..geometry.solids import SolidPair, Solids
from .penetration_study import Contact, PairKind, PartPair


@dataclass(frozen=True)
class RestingSolids:
    """The solids with every joint at lower, against which every pose and every way is held.

    Attributes:
        solids: posed by whoever asks.
        excluded: pairs of links that the file forbids to collide.
        config: limits, and steps of the search along a joint.
        lower, upper: the ends of the range of every joint that follows no other [rad] or [m].
        standings: pairs of solids that are near each other at rest.
        diagonal: of the object there [m].
        knuckles: pairs of solids (lower index first) that are some hinge's knuckle.
    """

    solids: Solids
    excluded: frozenset[frozenset[str]]
    config: PenetrationConfig
    lower: Mapping[str, float]
    upper: Mapping[str, float]
    standings: tuple[SolidPair, ...]
    diagonal: float
    knuckles: frozenset[PartPair] = frozenset()

    @cached_property
    def _overlaps(self) -> Mapping[PartPair, HullOverlap]:
        """How the solids of ``standings`` stand, by their indices."""
        return {(pair.first, pair.second): pair.overlap for pair in self.standings}

    def overlap(self, first: int, second: int) -> HullOverlap | None:
        """Return how two solids stand at rest, the lower index first; ``None`` if not near."""
        return self._overlaps.get((min(first, second), max(first, second)))

    def depth(self, first: int, second: int) -> float:
        """Return how deep two solids penetrate each other at rest [m]; 0 where they do not."""
        overlap = self.overlap(first, second)
        return 0.0 if overlap is None else max(0.0, overlap.depth)

    def kind(self, first: int, second: int) -> PairKind:
        """Return how an overlap of the pair counts."""
        links = frozenset((self.solids.items[first].link, self.solids.items[second].link))
        if links in self.excluded:
            return PairKind.EXCLUDED
        pair = min(first, second), max(first, second)
        return PairKind.HINGE if pair in self.knuckles else PairKind.PLAIN

    def parts(self, first: int, second: int) -> PartPair:
        """Return the two parts, lower index first."""
        a = self.solids.items[first].part
        b = self.solids.items[second].part
        return min(a, b), max(a, b)

    def contact(
        self,
        first: int,
        second: int,
        depth: float,
        kind: PairKind,
        pose: Mapping[str, float],
        *,
        located: bool = True,
    ) -> Contact:
        """Return what there is to say of two solids that are posed for some joint values.

        They penetrate each other by ``depth`` [m]. Where they do is looked for only if the contact
        is to be located, which takes long between round hulls.
        """
        a = self.solids.items[first]
        b = self.solids.items[second]
        point = None
        if located and depth >= 0.0:
            region = contact_region(a.collider.hull, b.collider.hull)
            point = tuple(float(x) for x in region.mean(axis=0)) if len(region) else None
        which = (self.parts(first, second), (first, second))
        names = ((a.link, b.link), (a.shape, b.shape))
        return Contact(*which, *names, depth, self.depth(first, second), point, kind, pose)

    def worst(
        self, standings: Iterable[SolidPair], pose: Mapping[str, float]
    ) -> tuple[Contact, ...]:
        """Return the deepest contact of every pair of parts and kind, in the order of parts."""
        deepest: dict[tuple[PartPair, PairKind], SolidPair] = {}
        for pair in standings:
            key = self.parts(pair.first, pair.second), self.kind(pair.first, pair.second)
            if key not in deepest or pair.overlap.depth > deepest[key].overlap.depth:
                deepest[key] = pair
        found = ((deepest[key], key[1]) for key in sorted(deepest))
        told = ((each.first, each.second, each.overlap.depth, kind) for each, kind in found)
        return tuple(self.contact(*each, pose) for each in told)
