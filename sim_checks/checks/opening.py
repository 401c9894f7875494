"""The order in which joints open: an obstacle may make way if it can open before.

A drawer behind a door is sound furniture. Two drawers each of which opens only after the other are
not: nothing can ever be opened. So a joint opens if its way is free with the others at lower, or
with such others at upper as have been found to open themselves, one after the other, without it.
Joints that make way only half open are not thought of.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

from ..description import JointLine
from .joint_sweep import JointCourse, clear_until
from .pairs import RestingSolids
from .penetration_study import JointSweep, PairKind, PairSweep

#: How often the joints that make way are added to, because another part stands behind them.
WIDENED = 3

Names = frozenset[str]
CLOSED: Names = frozenset()


def judge_joints(joints: Sequence[JointLine], rest: RestingSolids) -> tuple[JointSweep, ...]:
    """Sweep every joint with the others at lower; if it fails, again with obstacles opened.

    Asked are joints with a range that follow no other, in file order.
    """
    courses = {joint.name: JointCourse(joint, rest, rest.lower) for joint in joints}
    order = _OpeningOrder(rest, courses)
    order.settle()
    return tuple(order.judged(joint.name) for joint in joints)


@dataclass(frozen=True)
class _OpeningOrder:
    """Which joints must open before which.

    Attributes:
        rest: the solids, and their contacts at rest.
        courses: every joint's way with the others at lower, by name.
        needs: for every joint that opens the others that must be open, itself in the order in which
            they open.
        swept: every way that was looked at, by name and by the joints that were open.
    """

    rest: RestingSolids
    courses: dict[str, JointCourse]
    needs: dict[str, Names] = field(default_factory=dict)
    swept: dict[tuple[str, Names], JointSweep] = field(default_factory=dict)

    def settle(self) -> None:
        """Let joints open until no further one does."""
        while True:
            freed = {name: self._freed(name) for name in self.courses if name not in self.needs}
            opened = {name: needs for name, needs in freed.items() if needs is not None}
            if not opened:
                return
            self.needs.update(opened)

    def judged(self, name: str) -> JointSweep:
        """Return one joint, once all is settled."""
        first = self._swept(name, CLOSED)
        if not (failing := self._failing(first)):
            return first
        if name in self.needs:
            ordered = tuple(other for other in self.needs if other in self.needs[name])
            alternative = self._swept(name, self.needs[name])
            return replace(first, needs_open=ordered, alternative=alternative)
        worst = max(failing, key=lambda pair: pair.excess)
        # Pairs that are clear on the whole way are clear on a part of it.
        course = replace(self.courses[name], only=frozenset(pair.parts for pair in failing))
        waits = tuple(sorted(self._between(failing) - {name, *self.needs}))
        return replace(first, clear_until=clear_until(course, worst), waits_for=waits)

    def _swept(self, name: str, opened: Names) -> JointSweep:
        if (name, opened) not in self.swept:
            values = {**self.rest.lower, **{other: self.rest.upper[other] for other in opened}}
            self.swept[name, opened] = replace(self.courses[name], values=values).run()
        return self.swept[name, opened]

    def _clean(self, name: str, opened: Names) -> bool:
        return self._swept(name, opened).excess <= self.rest.config.excess_m

    def _freed(self, name: str) -> Names | None:
        """Return the joints with which open this one opens; ``None`` if there are none."""
        for opened in self._trials(name):
            if self._clean(name, opened) and self._together(opened):
                return opened
        return None

    def _trials(self, name: str) -> Iterator[Names]:
        """Yield sets of joints that may make way, with all that each needs; likely ones first."""
        opened = CLOSED
        yield opened
        for widened in range(WIDENED):
            failing = self._failing(self._swept(name, opened))
            makers = [self._between([pair]) & frozenset(self.needs) for pair in failing]
            if not all(makers):
                # What nothing but this joint moves, or nothing that opens, stays where it is.
                if not widened:
                    return
                break
            for maker in sorted(frozenset.intersection(*makers) if makers else ()):
                yield self._with_needs(opened | {maker})
            opened = self._with_needs(opened.union(*makers))
            yield opened
        yield frozenset(self.needs)

    def _failing(self, sweep: JointSweep) -> list[PairSweep]:
        plain = (pair for pair in sweep.pairs if pair.kind is PairKind.PLAIN)
        return [pair for pair in plain if pair.excess > self.rest.config.excess_m]

    def _between(self, failing: Sequence[PairSweep]) -> Names:
        return CLOSED.union(*(self.rest.solids.between(*pair.parts) for pair in failing))

    def _with_needs(self, names: Names) -> Names:
        return names.union(*(self.needs[name] for name in names))

    def _together(self, opened: Names) -> bool:
        """Return whether all of them open one after the other."""
        done = CLOSED
        while done != opened:
            left = (name for name in self.needs if name in opened - done)
            ready = next((name for name in left if self._clean(name, done)), None)
            if ready is None:
                return False
            done |= {ready}
        return True
