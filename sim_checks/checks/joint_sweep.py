"""One joint over its whole range: every pair of parts that it moves against one another."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..config import PenetrationConfig
from ..depth import contact_region
from ..description import JointLine
from ..path import Path
from ..solids import Standing
from ..sweep import Candidate, Sweep, Tolerance, Worst
from .hinge import within
from .pairs import Pairs
from .penetration_report import JointSweep, PairKind, PairSweep, PartPair

#: Fewest and most intervals that a joint's range is cut into before refinement.
MIN_STEPS, MAX_STEPS = 8, 256
#: Halvings of the range in search of where a failing joint is still clear.
CLEAR_HALVINGS = 7

Groups = dict[tuple[PartPair, PairKind], list[Candidate]]


@dataclass(frozen=True)
class Rest:
    """The pose that every sweep is held against.

    Attributes:
        lower, upper: the ends of every joint's range [rad] or [m].
        standings: pairs of solids that are near each other with every joint at lower.
        diagonal: of the object there [m].
    """

    lower: Mapping[str, float]
    upper: Mapping[str, float]
    standings: tuple[Standing, ...]
    diagonal: float


def judge_joint(joint: JointLine, pairs: Pairs, rest: Rest, config: PenetrationConfig) -> JointSweep:
    """Sweep with the other joints at lower; what fails is swept again with the others at upper."""
    course = Course(joint, pairs, rest, config, rest.lower)
    first = course.run()
    if first.excess <= config.excess_m:
        return first
    second = replace(course, values={**rest.upper, joint.name: rest.lower[joint.name]}).run()
    if second.excess <= config.excess_m:
        return first.with_alternative(second)
    worst = max((pair for pair in first.pairs if pair.contact.kind is PairKind.PLAIN), key=lambda pair: pair.excess)
    return replace(first, clear_until=clear_until(course, worst))


def clear_until(course: Course, failing: PairSweep) -> float:
    """How far a joint goes from lower before a pair of that kind fails [rad] or [m], found by halving: never too far.

    Args:
        course: the joint's way; what it looks at decides which pairs count.
        failing: fails where it is worst.
    """
    name, course = course.joint.name, replace(course, located=False)
    clear, fails = course.rest.lower[name], failing.at
    for _ in range(CLEAR_HALVINGS):
        middle = (clear + fails) / 2.0
        shorter = replace(course, rest=replace(course.rest, upper={**course.rest.upper, name: middle})).run()
        worst = max((pair.excess for pair in shorter.pairs if pair.contact.kind is failing.contact.kind), default=0.0)
        clear, fails = (middle, fails) if worst <= course.config.excess_m else (clear, middle)
    return clear


@dataclass(frozen=True)
class Course:
    """One joint from lower to upper while the others stand still.

    Attributes:
        joint: which moves.
        pairs: the solids.
        rest: what is no news, and the range.
        config: what is allowed, and how finely to look.
        values: where the other joints stand [rad] or [m].
        only: the pairs of parts to look at; ``None`` for all.
        motion: another motion than the joint's own, from the same start.
        located: say where in space the pairs meet, too.
    """

    joint: JointLine
    pairs: Pairs
    rest: Rest
    config: PenetrationConfig
    values: Mapping[str, float]
    only: frozenset[PartPair] | None = None
    motion: Path | None = None
    located: bool = True

    def run(self) -> JointSweep:
        """The worst of every pair of parts along the way."""
        start, end = self.rest.lower[self.joint.name], self.rest.upper[self.joint.name]
        path = self.path()
        moving, standing = self._sides()
        sweep = self._prepared(path, moving, standing)
        found: dict[tuple[PartPair, PairKind], PairSweep] = {}
        for (parts, kind), candidates in sorted(self._groups(sweep, moving, standing).items(), key=lambda e: e[0]):
            # Knuckles are few and each has to be one by itself.
            batches = [[item] for item in candidates] if kind is PairKind.HINGE else [candidates]
            for batch in batches:
                worst = sweep.worst(batch, self._tolerance())
                if worst is None:
                    continue
                pair = self._pair(parts, kind, worst, sweep, (moving, standing))
                key = parts, pair.contact.kind
                if key not in found or pair.excess > found[key].excess:
                    found[key] = pair
        ordered = tuple(found[key] for key in sorted(found))
        return JointSweep(self.joint.name, self.joint.kind, start, end, ordered, sweep.looks)

    def path(self) -> Path:
        """The motion; the solids are placed where it starts."""
        solids, name = self.pairs.solids, self.joint.name
        poses = solids.place({**self.values, name: self.rest.lower[name]})
        length = self.rest.upper[name] - self.rest.lower[name]
        own = solids.path(self.joint, poses, length)
        return own if self.motion is None else replace(self.motion, length=length)

    def _sides(self) -> tuple[list[int], list[int]]:
        """The solids that move and those that they may meet."""
        solids = self.pairs.solids
        part_of = solids.tree.part_of()
        below = {part_of[name] for name in solids.tree.below(self.joint)}
        parts = set(range(len(solids.tree.parts))) if self.only is None else {p for pair in self.only for p in pair}
        wanted = [index for index, item in enumerate(solids.items) if item.part in parts]
        moving = [index for index in wanted if solids.items[index].part in below]
        return moving, [index for index in wanted if solids.items[index].part not in below]

    def _tolerance(self) -> Tolerance:
        return Tolerance(floor=self.config.clearance_m, limit=self.config.excess_m)

    def _prepared(self, path: Path, moving: Sequence[int], standing: Sequence[int]) -> Sweep:
        items = self.pairs.solids.items
        colliders = [items[index].collider for index in moving]
        reach = path.travel(np.vstack([np.zeros((0, 3)), *(collider.hull.vertices for collider in colliders)]))
        step = self.config.step_fraction * self.rest.diagonal
        steps = int(np.clip(np.ceil(reach / step) if step > 0.0 else 1, MIN_STEPS, MAX_STEPS))
        return Sweep(path, colliders, [items[index].collider for index in standing], steps)

    def _groups(self, sweep: Sweep, moving: Sequence[int], standing: Sequence[int]) -> Groups:
        known = {(pair.first, pair.second): pair.overlap for pair in self.rest.standings}
        at_rest = self.values == self.rest.lower
        groups: Groups = {}
        for row, column in np.argwhere(sweep.near(self.config.clearance_m)).tolist():
            mover, stander = moving[row], standing[column]
            if self.only is not None and self.pairs.parts(mover, stander) not in self.only:
                continue
            overlap = known.get((min(mover, stander), max(mover, stander)))
            rest = 0.0 if overlap is None else max(0.0, overlap.depth)
            # Directions known at rest hold for this path only if it starts there.
            usable = overlap is not None and at_rest
            directions = (overlap.direction * (1.0 if mover < stander else -1.0),) if usable and overlap else ()
            group = self.pairs.parts(mover, stander), self.pairs.kind(mover, stander)
            groups.setdefault(group, []).append(Candidate(row, column, rest, directions))
        return groups

    def _pair(
        self, parts: PartPair, kind: PairKind, worst: Worst, sweep: Sweep, lists: tuple[list[int], list[int]]
    ) -> PairSweep:
        first, second = lists[0][worst.candidate.moving], lists[1][worst.candidate.standing]
        sweep.place(worst.candidate.moving, worst.at)
        if kind is PairKind.HINGE and not self._still_knuckle(first, second, worst, sweep.path):
            kind = PairKind.PLAIN
        at = self.rest.lower[self.joint.name] + float(worst.at)
        pose = {**self.values, self.joint.name: at}
        contact = self.pairs.contact(first, second, worst.depth, kind, pose, located=self.located)
        return PairSweep(parts, contact, float(worst.excess), float(worst.bound), at)

    def _still_knuckle(self, first: int, second: int, worst: Worst, path: Path) -> bool:
        """A knuckle stays within its radius and never gains more than it had."""
        items = self.pairs.solids.items
        region = contact_region(items[first].collider.hull, items[second].collider.hull)
        near = len(region) == 0 or within(region, path, self.config.hinge_radius_m)
        return near and worst.excess <= max(self.config.excess_m, worst.candidate.rest)
