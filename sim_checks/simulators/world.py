"""A loaded asset, as an engine holds it and moves it: one interface for all of them."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import numpy as np

from ..description import FloatArray, Mimic
from ..geometry.coupling import Limits, common_ranges, sound_chains, whole_chain

#: A joint without limits is swept through one turn; its sliding cousin has no sweep of its own.
FULL_TURN = 2.0 * math.pi

#: Names of joints that cannot reach one another, by group.
Groups = tuple[tuple[str, ...], ...]
Triple = tuple[float, float, float]


def triple(values: Iterable[float]) -> Triple:
    """Return three numbers as Python's own."""
    a, b, c = (float(v) for v in values)
    return a, b, c


@dataclass(frozen=True)
class LoadedLink:
    """A link as the simulator holds it.

    Attributes:
        name: link name.
        mass: [kg]; 0 where the engine holds it as part of the static world.
        shapes: how many collision shapes arrived.
        moments: principal moments of inertia about the centre of mass [kg m2], ascending; ``None``
            if static.
        center: centre of mass in the link's frame [m]; ``None`` if static.
        static: the engine never moves it, so its mass and inertia play no part.
        friction: contact friction coefficient, the largest of its shapes'; ``None`` without shapes.
    """

    name: str
    mass: float
    shapes: int
    moments: Triple | None
    center: Triple | None = None
    static: bool = False
    friction: float | None = None


@dataclass(frozen=True)
class LoadedJoint:
    """A joint as the simulator holds it.

    Attributes:
        name: joint name.
        kind: ``revolute``, ``continuous``, ``prismatic``, or the engine's word for anything else;
            fixed joints are not listed, since not every engine keeps them.
        lower, upper: [rad] or [m]; infinite where it has none.
        damping: [N m s/rad] or [N s/m]; ``None`` if the engine has no such property.
        friction: [N m] or [N], as enforced; ``None`` if the engine has no such property.
        axis: unit vector in the child link's frame; ``None`` for a joint without one axis.
        mimic: the joint that this one is forced to move with, and how (``<mimic>``, MJCF's joint
            equality); ``None`` for a free one.
        forced_by_judge: the engine itself lets it move freely, it is forced here by means of the
            engine.
    """

    name: str
    kind: str
    lower: float
    upper: float
    damping: float | None
    friction: float | None
    axis: Triple | None = None
    mimic: Mimic | None = None
    forced_by_judge: bool = False

    @property
    def follows(self) -> str | None:
        """Return the joint that it is forced to move with."""
        return None if self.mimic is None else self.mimic.leader


@dataclass(frozen=True)
class PairRules:
    """Which links the engine lets touch, as loaded.

    All touch that no joint joins: siblings, and links further apart, also across a fixed joint.

    Attributes:
        moving_parent: whether a link touches the link it is jointed to, where that link moves
            itself.
        static_parent: the same where that link belongs to the unmoved base.
        excluded: pairs that would touch by these rules, and that the file or the files beside it
            exempt.
    """

    moving_parent: bool
    static_parent: bool
    excluded: tuple[tuple[str, str], ...] = ()

    def words(self) -> dict[str, Any]:
        """Return the rules in words, for the report."""
        yes_no = {True: "touch", False: "pass through each other"}
        return {
            "link_and_moving_parent": yes_no[self.moving_parent],
            "link_and_unmoved_parent": yes_no[self.static_parent],
            "siblings_and_further": "touch",
            "excluded": [list(pair) for pair in self.excluded],
        }


@dataclass(frozen=True)
class LoadedModel:
    """Everything a loader kept."""

    links: tuple[LoadedLink, ...]
    joints: tuple[LoadedJoint, ...]
    pairs: PairRules | None = None


@dataclass(frozen=True)
class Touch:
    """How two links touch after a step.

    Attributes:
        force: how hard they press on each other [N]; PhysX reports none where it moves overlapping
            parts apart at once instead of accelerating them.
        depth: how deep they penetrate each other [m]; negative for a gap that the engine watches.
    """

    force: float
    depth: float

    @property
    def presses(self) -> bool:
        """Return whether it does anything."""
        return self.force > 0.0 or self.depth > 0.0


class Touches(dict[tuple[str, str], Touch]):
    """How links touch, by pair in the model's order."""

    def add(self, pair: tuple[str, str], force: float, depth: float) -> None:
        """Note one more contact of a pair of links: its force [N] and its depth [m]."""
        before = self.get(pair, Touch(0.0, -math.inf))
        self[pair] = Touch(before.force + force, max(before.depth, depth))


@dataclass(frozen=True)
class Ranges:
    """Where each joint is driven from and to [rad] or [m], shape [joint_count] each.

    One that follows another is where that one takes it, so its ``upper`` may lie below its
    ``lower``.
    """

    lower: FloatArray
    upper: FloatArray

    @property
    def travel(self) -> FloatArray:
        """Return the upper minus lower; negative for a joint that another takes backwards."""
        return self.upper - self.lower

    @property
    def size(self) -> FloatArray:
        """Return the same without its sign; 0 for a joint that is not driven."""
        return np.abs(self.travel)


class World(Protocol):
    """A loaded asset, its base fixed, gravity on, self-collision on, ready to be moved.

    Vectors are ordered as :attr:`joints`. A world without joints is only asked where its links are.

    Attributes:
        model: what arrived.
        joints: those that :meth:`step` pushes, all with one degree of freedom.
        time_step: what one :meth:`step` advances [s].
        carried: the names of the links that each joint moves.
    """

    model: LoadedModel
    joints: tuple[LoadedJoint, ...]
    time_step: float
    carried: tuple[frozenset[str], ...]

    def weigh(self, on: bool) -> None:
        """Turn gravity and springs on, as after loading, or off."""

    def place(self, positions: FloatArray) -> None:
        """Put the joints there, at rest."""

    def positions(self) -> FloatArray:
        """Return joint values [rad] or [m], shape [joint_count]."""

    def velocities(self) -> FloatArray:
        """Return joint speeds [rad/s] or [m/s], shape [joint_count]."""

    def mass_matrix(self) -> FloatArray:
        """Return the mass matrix [kg m2], [kg m] or [kg], shape [joint_count, joint_count]."""

    def energy(self) -> float:
        """Return the kinetic energy plus potential energy of gravity and springs that are on [J].

        The zero is arbitrary.
        """

    def balance(self) -> FloatArray:
        """Return the forces that balance gravity, velocity effects and springs [N m] or [N].

        Shape [joint_count].
        """

    def step(self, forces: FloatArray) -> None:
        """Make one time step with these joint forces [N m] or [N], shape [joint_count]."""

    def contacts(self) -> Touches:
        """Return which links touched in the last step, by pair in the model's order."""

    def link_poses(self) -> dict[str, FloatArray]:
        """Link frames in world here, shape [4, 4] each."""

    def warnings(self) -> tuple[str, ...]:
        """Return what the engine complained about while moving; most cannot be asked."""
        return ()

    def close(self) -> None:
        """Release everything, so that the next world finds the engine as new; then ask no more."""

    @cached_property
    def span(self) -> Ranges:
        """Return the drive's ends: the limits, or 0 to a full turn, or 0 to 0.

        A full turn is for joints without limits, 0 to 0 for those with nothing sensible. A leader
        goes as far as all that follow it can, and they go along. Put at their own lower limits
        instead, two doors of which one follows the other backwards would begin with one of them
        open.
        """
        sound = sound_chains({joint.name: joint.mimic for joint in self.joints})
        free = {joint.name: _ends(joint) for joint in self.joints if joint.name not in sound}
        limited = (joint for joint in self.joints if joint.lower < joint.upper)
        limits = {joint.name: (joint.lower, joint.upper) for joint in limited} | free
        common = common_ranges(limits, sound)
        ends = {name: common.get(name, (lower, lower)) for name, (lower, _) in free.items()}
        for name in sound:
            whole = whole_chain(name, sound)
            lower, upper = (whole.multiplier * end + whole.offset for end in ends[whole.leader])
            ends[name] = lower, upper
        both = np.array([ends[joint.name] for joint in self.joints], np.float64).reshape(-1, 2)
        return Ranges(both[:, 0], both[:, 1])

    def companions(self, index: int) -> frozenset[int]:
        """Return the joint and all that are forced to move with it."""
        pairs = [{joint.name, joint.follows} for joint in self.joints if joint.follows is not None]
        found: set[str | None] = {self.joints[index].name}
        for _ in pairs:
            found |= {name for pair in pairs if pair & found for name in pair}
        return frozenset(i for i, joint in enumerate(self.joints) if joint.name in found)

    @property
    def uncoupled(self) -> list[int]:
        """Return joints that no other is forced to move with; the rest may move without contact."""
        return [i for i in range(len(self.joints)) if len(self.companions(i)) == 1]

    def standing_open(self, opened: Iterable[int]) -> FloatArray:
        """Return joints at upper, with all that move with them, and the others at lower."""
        values = self.span.lower.copy()
        together = sorted(frozenset[int]().union(*map(self.companions, opened)))
        values[together] = self.span.upper[together]
        return values

    def pressing(self, index: int) -> tuple[str, str] | None:
        """Return the links that pressed hardest in the last step, one of them moved by a joint.

        Names come in the order of the model's links; ``None`` if nothing presses across the joint.
        """
        moved = self.carried[index]
        presses = ((pair, touch) for pair, touch in self.contacts().items() if touch.presses)
        across = ((p, touch) for p, touch in presses if (p[0] in moved) != (p[1] in moved))
        return max(((t.force, t.depth, p) for p, t in across), default=(0.0, 0.0, None))[2]

    @property
    def carries_joints(self) -> bool:
        """Return whether a joint moves another one, so that the mass matrix changes as it does."""
        each = sum(len(links) for links in self.carried)
        return each > len(frozenset[str]().union(*self.carried))

    @property
    def carried_masses(self) -> FloatArray:
        """Return the mass that each joint moves [kg], shape [joint_count]."""
        return np.array([self._mass_of(names) for names in self.carried], np.float64)

    @property
    def moving_mass(self) -> float:
        """Return the mass of all that any joint moves [kg]."""
        return self._mass_of(frozenset[str]().union(*self.carried))

    def is_finite(self) -> bool:
        """Return whether all is still a number: where joints are, and how they move."""
        return bool(np.isfinite(self.positions()).all() and np.isfinite(self.velocities()).all())

    def _mass_of(self, names: frozenset[str]) -> float:
        return float(sum(link.mass for link in self.model.links if link.name in names))


def _ends(joint: LoadedJoint) -> Limits:
    lower = joint.lower
    upper = joint.upper
    if not (math.isfinite(lower) and math.isfinite(upper)):
        return 0.0, FULL_TURN if joint.kind in ("revolute", "continuous") else 0.0
    return lower, max(lower, upper)
