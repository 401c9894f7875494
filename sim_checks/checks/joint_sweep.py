"""One joint and its followers over the whole range: every pair of parts in relative motion."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from operator import itemgetter

import numpy as np

from ..description import FloatArray, JointLine
from ..geometry.depth import contact_region
from ..geometry.path import JointAxis, Path, joint_axis
from ..geometry.solids import SolidGroup
from ..geometry.sweep import Candidate, Sweep, Tolerance, Worst
from .pairs import RestingSolids, within
from .penetration_study import JointSweep, PairKind, PairSweep, PartPair

#: Fewest and most intervals that a joint's range is cut into before refinement.
MIN_STEPS = 8
MAX_STEPS = 256
#: Halvings of the range in search of where a failing joint is still clear.
CLEAR_HALVINGS = 7

Candidates = dict[tuple[PartPair, PairKind], list[Candidate]]


def clear_until(course: JointCourse, failing: PairSweep) -> float:
    """Return how far a joint goes from lower before such a pair fails [rad] or [m]; never too far.

    Found by halving. What the course looks at decides which pairs count.
    """
    course = replace(course, decides=True)
    clear = course.rest.lower[course.joint.name]
    fails = failing.at
    for _ in range(CLEAR_HALVINGS):
        middle = (clear + fails) / 2.0
        pairs = replace(course, until=middle).run().pairs
        alike = (pair for pair in pairs if pair.kind is failing.kind)
        worst = max((pair.excess for pair in alike), default=0.0)
        clear, fails = (middle, fails) if worst <= course.rest.config.excess_m else (clear, middle)
    return clear


@dataclass(frozen=True)
class JointCourse:
    """One joint from lower to upper, its followers with it, while the others stand still.

    Attributes:
        joint: which moves; it follows no other.
        rest: the solids, and their contacts at rest.
        values: where the other joints stand [rad] or [m]; of those that follow none.
        only: the pairs of parts to look at; ``None`` for all.
        motion: another motion than the joint's own, from the same start; only for one that has no
            followers.
        decides: tell only whether pairs penetrate too deeply, not how deep, nor where in space.
        until: where it ends [rad] or [m]; ``None`` for upper.
    """

    joint: JointLine
    rest: RestingSolids
    values: Mapping[str, float]
    only: frozenset[PartPair] | None = None
    motion: JointAxis | None = None
    decides: bool = False
    until: float | None = None

    def run(self) -> JointSweep:
        """Return the worst of every pair of parts along the way."""
        start = self.rest.lower[self.joint.name]
        found: dict[tuple[PartPair, PairKind], PairSweep] = {}
        looks = 0
        # Without followers there are two groups only: what moves and what stands.
        for standing, moving in combinations(self._groups(), 2):
            encounter = self._encounter(moving, standing)
            for pair in encounter.pairs():
                key = pair.parts, pair.kind
                if key not in found or pair.excess > found[key].excess:
                    found[key] = pair
            looks += encounter.sweep.looks
        ordered = tuple(found[key] for key in sorted(found))
        return JointSweep(self.joint, start, start + self.length, ordered, looks)

    def line(self) -> JointAxis:
        """Return the line of the joint's own motion; the solids are placed where it starts."""
        return joint_axis(self.joint, self._placed()[self.joint.child])

    @property
    def length(self) -> float:
        """Return how far it goes [rad] or [m]."""
        name = self.joint.name
        end = self.rest.upper[name] if self.until is None else self.until
        return end - self.rest.lower[name]

    def _placed(self) -> Mapping[str, FloatArray]:
        name = self.joint.name
        return self.rest.solids.place({**self.values, name: self.rest.lower[name]})

    def _groups(self) -> tuple[SolidGroup, ...]:
        """Return the solids that are looked at, those that stand first."""
        groups = self.rest.solids.groups(self.joint)
        if self.only is None:
            return groups
        parts = {part for pair in self.only for part in pair}
        items = self.rest.solids.items
        kept = (tuple(i for i in group.solids if items[i].part in parts) for group in groups)
        return tuple(replace(g, solids=solids) for g, solids in zip(groups, kept, strict=True))

    def _encounter(self, moving: SolidGroup, standing: SolidGroup) -> _Encounter:
        solids = self.rest.solids
        poses = self._placed()
        if self.motion is not None:
            path = self.motion.path(self.length)
        else:
            path = solids.seen(moving, standing, poses, self.length)
        reach = path.travel(solids.points(moving.solids))
        step = self.rest.config.step_fraction * self.rest.diagonal
        steps = int(np.clip(np.ceil(reach / step) if step > 0.0 else 1, MIN_STEPS, MAX_STEPS))
        groups = (moving, standing)
        mover, still = ([solids.items[i].collider for i in group.solids] for group in groups)
        sweep = Sweep(path, mover, still, steps, solids.looks)
        frame = solids.way(standing, poses, self.length) if standing.ways else None
        return _Encounter(self, sweep, moving.solids, standing.solids, frame)


@dataclass(frozen=True)
class _Encounter:
    """One group of solids that move as one against another, as seen from that other.

    Attributes:
        course: whose part this is.
        sweep: looks.
        moving, standing: the solids that the sweep counts from 0.
        frame: how that other moves itself; ``None`` if it stands.
    """

    course: JointCourse
    sweep: Sweep
    moving: Sequence[int]
    standing: Sequence[int]
    frame: Path | None

    def pairs(self) -> Iterator[PairSweep]:
        """Yield the worst places, one or more for each pair of parts and kind."""
        config = self.course.rest.config
        for (_, kind), candidates in sorted(self._candidates().items(), key=itemgetter(0)):
            # Whether a knuckle stays one is seen where it is worst.
            decides = self.course.decides and kind is PairKind.PLAIN
            tolerance = Tolerance(floor=config.clearance_m, limit=config.excess_m, decides=decides)
            # Knuckles are few and each has to be one by itself.
            batches = [[item] for item in candidates] if kind is PairKind.HINGE else [candidates]
            for batch in batches:
                worst = self.sweep.worst(batch, tolerance)
                if worst is not None:
                    yield self._pair(kind, worst)

    def _candidates(self) -> Candidates:
        rest = self.course.rest
        only = self.course.only
        at_rest = self.course.values == rest.lower
        groups: Candidates = {}
        for row, column in np.argwhere(self.sweep.near(rest.config.clearance_m)).tolist():
            mover = self.moving[row]
            stander = self.standing[column]
            if only is not None and rest.parts(mover, stander) not in only:
                continue
            overlap = rest.overlap(mover, stander)
            known = None
            # A direction known at rest holds for this path only if it starts there.
            if overlap is not None and at_rest:
                known = overlap.direction * (1.0 if mover < stander else -1.0)
            group = rest.parts(mover, stander), rest.kind(mover, stander)
            candidate = Candidate(row, column, rest.depth(mover, stander), known)
            groups.setdefault(group, []).append(candidate)
        return groups

    def _pair(self, kind: PairKind, worst: Worst) -> PairSweep:
        course = self.course
        first = self.moving[worst.candidate.moving]
        second = self.standing[worst.candidate.standing]
        self.sweep.place(worst.candidate.moving, worst.at)
        at = course.rest.lower[course.joint.name] + float(worst.at)
        pose = {**course.values, course.joint.name: at}
        # Where another motion or a shorter way meets anything, nobody asks.
        located = course.motion is None and not course.decides
        contact = course.rest.contact(first, second, worst.depth, pose, located=located)
        if kind is PairKind.HINGE and not self._still_knuckle(first, second, worst):
            contact = replace(contact, kind=PairKind.PLAIN)
        if contact.point is not None and self.frame is not None:
            frame = self.frame.pose(worst.at)
            point = frame[:3, :3] @ contact.point + frame[:3, 3]
            contact = replace(contact, point=tuple(point.tolist()))
        return PairSweep(**vars(contact), bound=float(worst.bound), at=at)

    def _still_knuckle(self, first: int, second: int, worst: Worst) -> bool:
        """Return a knuckle stays within its radius and never gains more than it had."""
        items = self.course.rest.solids.items
        config = self.course.rest.config
        # What a hinge joins, it alone moves against one another.
        line, _ = self.sweep.path.steps[0]
        region = contact_region(items[first].collider.hull, items[second].collider.hull)
        near = len(region) == 0 or within(region, line, config.hinge_radius_m)
        return near and worst.excess <= max(config.excess_m, worst.candidate.rest)
