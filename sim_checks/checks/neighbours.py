"""Two joints open at once: one makes its whole way at each of several values of the other.

What two neighbours do to one another when only one of them is open is the single joints' business.
What they do when both are, a spread of poses may step over: here one is followed continuously, the
other stands at values from a little open to upper, and at finer ones around the deepest contact.
Both take either role.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from ..description import BoolArray, FloatArray, JointLine
from ..geometry.collision import LookBudget, TooManyLooks
from ..geometry.placing import box_around, boxes_near
from ..geometry.solids import Solids
from .joint_sweep import JointCourse, clear_until
from .pairs import RestingSolids
from .penetration_study import BothOpen, Neighbours, PairKind, PairSweep, PartPair

#: Values of a joint, from a little open to upper, at each of which the other is swept.
GRID = 4
#: How often the grid's step is halved around the deepest contact.
REFINED = 3
#: What a sweep counts besides its exact looks: it places every hull and compares their boxes.
SWEEP_LOOKS = 10


def open_neighbours(rest: RestingSolids, told: frozenset[PartPair]) -> Neighbours:
    """Sweep joints together whose ways meet; return the worst depth by pair of joints and parts.

    Only joints that do not move the same part are asked, and only what the one moves against what
    the other does; what follows a joint moves with it. Pairs of parts that meet while all joints
    but one are closed (``told``) are no news here.
    """
    rest = replace(rest, solids=rest.solids.counting(LookBudget(rest.config.pair_looks)))
    met: list[BothOpen] = []
    unswept = []
    asked = 0
    for first, second in _near(rest):
        moved = product(*map(rest.solids.moved_parts, (first, second)))
        only = frozenset((min(pair), max(pair)) for pair in moved)
        asked += 1
        try:
            met += _met(rest, first, second, only - told)
        except TooManyLooks:
            unswept.append((first.name, second.name))
    return Neighbours(tuple(met), asked, tuple(unswept))


def _met(
    rest: RestingSolids, first: JointLine, second: JointLine, only: frozenset[PartPair]
) -> Iterator[BothOpen]:
    """Yield the worst of every pair of parts that meet, whichever of two joints moves.

    Raises:
        TooManyLooks: the file has taken more than it may.
    """
    ways = (_Passing(rest, first, second), _Passing(rest, second, first))
    found = [item for way in ways for item in way.met(only)]
    for parts in sorted({item.pair.parts for item in found}):
        alike = (item for item in found if item.pair.parts == parts)
        worst = max(alike, key=lambda item: (item.obstructed, item.pair.excess))
        if worst.pair.excess > rest.config.excess_m:
            way = _Passing(rest, worst.joint, worst.other)
            course = way.course(worst.other_at, frozenset({parts}))
            worst = replace(worst, free_until=clear_until(course, worst.pair))
        yield worst


@dataclass(frozen=True)
class _Passing:
    """One joint that makes its way past another, which stands open."""

    rest: RestingSolids
    joint: JointLine
    other: JointLine

    def met(self, only: frozenset[PartPair]) -> Iterator[BothOpen]:
        """Yield the worst of every pair of parts that meet."""
        limits = self.rest.lower[self.other.name], self.rest.upper[self.other.name]
        grid = np.interp(np.linspace(self.rest.config.little_open, 1.0, GRID), (0.0, 1.0), limits)
        swept = {at: self._swept(at, only) for at in grid.tolist()}
        for parts in sorted(only):
            tried = {at: found[parts] for at, found in swept.items() if parts in found}
            failing = [at for at, pair in tried.items() if pair.excess > self.rest.config.excess_m]
            obstructed = len(failing) == GRID
            at = failing[0] if obstructed else self._deepest(parts, tried)
            if at is not None and tried[at].excess > 0.0:
                yield BothOpen(self.joint, self.other, tried[at], obstructed)

    def _deepest(self, parts: PartPair, tried: dict[float, PairSweep]) -> float | None:
        """Add finer values of the other around the deepest of those tried; return the deepest."""
        if not tried:
            return None
        low = self.rest.lower[self.other.name]
        high = self.rest.upper[self.other.name]
        step = (1.0 - self.rest.config.little_open) / (GRID - 1) * (high - low)
        for _ in range(REFINED):
            step /= 2.0
            middle = max(tried, key=lambda at: tried[at].excess)
            for at in (middle - step, middle + step):
                found = self._swept(at, frozenset({parts})) if low < at < high else {}
                tried.update((at, pair) for pair in found.values())
        return max(tried, key=lambda at: tried[at].excess)

    def _swept(self, at: float, only: frozenset[PartPair]) -> Mapping[PartPair, PairSweep]:
        """Return the worst of the pairs of parts that count, with the other at one value."""
        self.rest.solids.looks.take(SWEEP_LOOKS)
        found = self.course(at, only).run().pairs
        return {pair.parts: pair for pair in found if pair.kind is PairKind.PLAIN}

    def course(self, at: float, only: frozenset[PartPair]) -> JointCourse:
        """Return the joint's course with the other at one value [rad] or [m]."""
        return JointCourse(self.joint, self.rest, {**self.rest.lower, self.other.name: at}, only)


def _near(rest: RestingSolids) -> Iterator[tuple[JointLine, JointLine]]:
    """Yield the pairs of joints whose ways come near each other; file order."""
    solids = rest.solids
    joints = [joint for joint in solids.tree.free if joint.name in rest.lower]
    independent = _independent(solids, joints)
    swept = _swept(rest, [joints[i] for i in np.flatnonzero(independent.any(axis=1))])
    around = np.full((len(joints), 2, 3), np.nan)
    for index, joint in enumerate(joints):
        if joint.name in swept:
            around[index] = box_around([swept[joint.name]])
    # What is around all of it is compared first: most pairs of joints are far apart.
    for pair in np.argwhere(np.triu(independent & boxes_near(around, around))).tolist():
        first, second = (joints[index] for index in pair)
        if boxes_near(swept[first.name], swept[second.name]).any():
            yield first, second


def _independent(solids: Solids, joints: list[JointLine]) -> BoolArray:
    """Return which joints carry nothing that another moves, itself or by a follower; symmetric."""
    moves = np.zeros((len(joints), len(solids.tree.parts)), dtype=np.float32)
    for row, joint in enumerate(joints):
        moves[row, sorted(solids.moved_parts(joint))] = 1.0
    apart: BoolArray = moves @ moves.T == 0.0
    np.fill_diagonal(apart, val=False)
    return apart


def _swept(rest: RestingSolids, joints: list[JointLine]) -> Mapping[str, FloatArray]:
    """Return boxes around all below each joint, by interval from lower to upper [m]."""
    solids = rest.solids
    poses = solids.place(rest.lower)
    boxes: dict[str, FloatArray] = {}
    for joint in joints:
        length = rest.upper[joint.name] - rest.lower[joint.name]
        stands, *groups = solids.groups(joint)
        paths = ((g, solids.seen(g, stands, poses, length)) for g in groups if g.solids)
        found = [path.swept_boxes(solids.points(group.solids)) for group, path in paths]
        if found:
            boxes[joint.name] = np.vstack(found)
    return boxes
