"""Pairs of solids: how they stand at rest, which are exempt, and where they meet.

Exempt is what overlaps in a hinge's own knuckle, but no fault that lies near it. A knuckle is
short: two leaves share an axle somewhere along the hinge. A panel that overlaps its frame along the
whole hinge side is none, however near the axis that lies; nor is one whose edge turns into the
frame, because there nothing overlaps at rest.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..config import PenetrationConfig
from ..description import FloatArray
from ..geometry.depth import HullOverlap, contact_region
from ..geometry.path import JointAxis, joint_axis
from ..geometry.solids import HullPair, Solids
from .penetration_study import Contact, PairKind, PartPair

#: Depth that counts as touching [m].
TOUCH = 1e-6


@dataclass(frozen=True)
class RestingSolids:
    """The solids with every joint at lower, against which every pose and every way is held.

    Attributes:
        solids: posed by whoever asks.
        config: limits, and steps of the search along a joint.
        standings: how solids stand that are near each other at rest, see :meth:`Solids.standings`.
        diagonal: of the object there [m].
        knuckles: pairs of solids (lower index first) that are some hinge's knuckle.
    """

    solids: Solids
    config: PenetrationConfig
    standings: Mapping[HullPair, HullOverlap]
    diagonal: float
    knuckles: frozenset[HullPair] = frozenset()

    @property
    def lower(self) -> Mapping[str, float]:
        """Return where every joint that follows no other is at rest [rad] or [m]."""
        return self.solids.tree.closed

    @property
    def upper(self) -> Mapping[str, float]:
        """Return the other ends of their ranges [rad] or [m]."""
        return self.solids.tree.opened

    def overlap(self, first: int, second: int) -> HullOverlap | None:
        """Return how two solids stand at rest, the lower index first; ``None`` if not near."""
        return self.standings.get((min(first, second), max(first, second)))

    def depth(self, first: int, second: int) -> float:
        """Return how deep two solids penetrate each other at rest [m]; 0 where they do not."""
        overlap = self.overlap(first, second)
        return 0.0 if overlap is None else max(0.0, overlap.depth)

    def kind(self, first: int, second: int) -> PairKind:
        """Return how an overlap of the pair counts."""
        links = frozenset((self.solids.items[first].link, self.solids.items[second].link))
        if links in self.solids.description.excluded:
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
        kind = self.kind(first, second)
        return Contact(*which, *names, depth, self.depth(first, second), point, kind, pose)

    def worst(
        self, standings: Mapping[HullPair, HullOverlap], pose: Mapping[str, float]
    ) -> tuple[Contact, ...]:
        """Return the deepest contact of every pair of parts and kind, in the order of parts."""
        deepest: dict[tuple[PartPair, PairKind], HullPair] = {}
        for pair, overlap in standings.items():
            key = self.parts(*pair), self.kind(*pair)
            if key not in deepest or overlap.depth > standings[deepest[key]].depth:
                deepest[key] = pair
        found = (deepest[key] for key in sorted(deepest))
        return tuple(self.contact(*pair, standings[pair].depth, pose) for pair in found)


def at_rest(solids: Solids, config: PenetrationConfig) -> RestingSolids:
    """Place solids at rest, and return how they stand there.

    Raises:
        TooManyLooks: the file has taken more than it may.
    """
    poses = solids.place(solids.tree.closed)
    rest = RestingSolids(solids, config, solids.standings(config.clearance_m), solids.diagonal())
    return replace(rest, knuckles=_knuckles(rest, poses))


def _knuckles(rest: RestingSolids, poses: Mapping[str, FloatArray]) -> frozenset[HullPair]:
    """Return every pair of solids that is some hinge's knuckle at rest."""
    tree = rest.solids.tree
    part_of = tree.part_of()
    overlapping: dict[PartPair, list[HullPair]] = {}
    for pair, overlap in rest.standings.items():
        if overlap.depth > TOUCH:
            overlapping.setdefault(rest.parts(*pair), []).append(pair)
    found: set[HullPair] = set()
    for joint in tree.moving:
        if joint.kind == "prismatic" or not (joint.name in rest.lower or joint.name in tree.mimics):
            continue
        first, second = sorted((part_of[joint.parent], part_of[joint.child]))
        overlaps = overlapping.get((first, second), [])
        line = joint_axis(joint, poses[joint.child])
        found |= _knuckles_of(rest, overlaps, line, part_of[joint.child])
    return frozenset(found)


def _knuckles_of(
    rest: RestingSolids, overlaps: Sequence[HullPair], line: JointAxis, moving: int
) -> frozenset[HullPair]:
    """Return the pairs of solids whose overlap at rest is this hinge's knuckle.

    Solids are placed at rest; those that overlap are all of the two parts that the hinge joins.
    """
    inside: dict[HullPair, FloatArray] = {}
    for pair in overlaps:
        one, other = (rest.solids.items[index].collider.hull for index in pair)
        region = contact_region(one, other)
        if len(region) and within(region, line, rest.config.hinge_radius_m):
            inside[pair] = region
    if not inside:
        return frozenset()
    turning = rest.solids.points(np.flatnonzero(rest.solids.parts == moving).tolist())
    length = float(np.ptp(turning @ line.axis))
    heights = [region @ line.axis for region in inside.values()]
    taken = _covered([(float(each.min()), float(each.max())) for each in heights])
    return frozenset(inside) if taken <= rest.config.hinge_share * length else frozenset()


def within(region: FloatArray, line: JointAxis, radius: float) -> bool:
    """Return whether every point lies within ``radius`` [m] of the line."""
    return bool(np.linalg.norm(line.arms(region), axis=1).max() <= radius)


def _covered(spans: list[tuple[float, float]]) -> float:
    """Return the length of the union of intervals."""
    total = 0.0
    reached = -np.inf
    for low, high in sorted(spans):
        total += max(0.0, high - max(low, reached))
        reached = max(reached, high)
    return total
