"""The one interface behind which every physics engine stands."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from ..config import MotionConfig
from ..description import FloatArray, Mimic

JointValues = Mapping[str, float]
"""Joint name to value [rad] or [m]."""
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
    """Everything a loader kept, and what it said while loading."""

    links: tuple[LoadedLink, ...]
    joints: tuple[LoadedJoint, ...]
    warnings: tuple[str, ...]
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
class JointMotion:
    """What one joint did when driven from lower to upper and back.

    One that is forced to follow another is driven from where that one is at lower to where it is at
    upper, which may be the other way round.

    Attributes:
        joint: its name.
        reached: highest share of the range reached, 0..1.
        returned: share of the range left open at the end, 0..1; a joint that did not open is not
            driven back.
        overshoot: furthest beyond a limit [rad] or [m].
        others_moved: largest movement of any other joint, as a share of its own range.
        peak_speed: [rad/s] or [m/s].
        finite: False if a NaN or infinity appeared.
        range: how far it is driven [rad] or [m].
        needs_open: the other joints that were held at upper, since it does not open with all of
            them at lower.
        pushed: the other joint that moved most, if any moved.
        blocked_by: the two links that pressed hardest on each other where the joint was stopped,
            one of them moved by it; ``None`` if it was not stopped, or if nothing touches there.
        stuck_at: where it stayed [rad] or [m], if it did not arrive.
        opening_force: most that the hand pulled while opening, beyond what balances gravity and
            springs [N m] or [N].
        force_bound: most that the hand was allowed to pull [N m] or [N].
        weight_closed, weight_open: what holds the joint against gravity and springs at either end
            [N m] or [N]; positive at ``open``: left alone, it falls shut. ``None`` at ``open`` for
            a joint that did not arrive.
        energy: kinetic energy that any one joint gained after the hand let go, weightless [J].
        energy_height: the same as the height to which it would lift what that joint moves [m].
    """

    joint: str
    reached: float
    returned: float
    overshoot: float
    others_moved: float
    peak_speed: float
    finite: bool
    range: float = 0.0
    needs_open: tuple[str, ...] = ()
    pushed: str | None = None
    blocked_by: tuple[str, str] | None = None
    stuck_at: float | None = None
    opening_force: float = 0.0
    force_bound: float = 0.0
    weight_closed: float = 0.0
    weight_open: float | None = None
    energy: float = 0.0
    energy_height: float = 0.0


@dataclass(frozen=True)
class RestMotion:
    """What a joint did alone at lower without gravity and springs: any motion is contact.

    Attributes:
        joint: its name.
        drift: furthest from where it started [rad] or [m].
        share: the same as a share of its range.
        finite: False if a NaN or infinity appeared.
        energy: most kinetic energy that it had, from none [J].
        energy_height: the same as the height to which it would lift what the joint moves [m].
        pushed_by: the two links that pressed hardest on each other at the start, one of them moved
            by the joint.
    """

    joint: str
    drift: float
    share: float
    finite: bool
    energy: float = 0.0
    energy_height: float = 0.0
    pushed_by: tuple[str, str] | None = None


@dataclass(frozen=True)
class FallMotion:
    """What a joint did under its own weight, left alone at lower with gravity and springs on.

    Attributes:
        joint: its name.
        moved: furthest into its range [rad] or [m]; either way for a joint without limits.
        share: the same as a share of its range.
    """

    joint: str
    moved: float
    share: float


@dataclass(frozen=True)
class Fall:
    """The object left alone with every joint at lower, gravity and springs on.

    Attributes:
        joints: those that are not coupled to others.
        finite: False if a NaN or infinity appeared.
        energy: how far kinetic and potential energy together rose above what they were [J]; none
            should.
        energy_height: the same as the height to which it would lift all that moves [m].
    """

    joints: tuple[FallMotion, ...] = ()
    finite: bool = True
    energy: float = 0.0
    energy_height: float = 0.0


@dataclass(frozen=True)
class HoldMotion:
    """What a joint did when left alone part-way open, under gravity, where friction should hold it.

    Attributes:
        joint: its name.
        values: where every joint was placed [rad] or [m].
        moved: furthest from there [rad] or [m].
        finite: False if a NaN or infinity appeared.
        pressed_by: the two links that pressed hardest on each other at the end, one of them moved
            by the joint.
    """

    joint: str
    values: JointValues
    moved: float
    finite: bool = True
    pressed_by: tuple[str, str] | None = None


@dataclass(frozen=True)
class PoseSample:
    """Where the simulator puts each link for given joint values.

    Attributes:
        values: movable joint values [rad] or [m]; joints not named are at 0.
        poses: link frame in world, base link's frame at the origin, shape [4, 4], per link name.
    """

    values: JointValues
    poses: Mapping[str, FloatArray]


@dataclass(frozen=True)
class Observation:
    """All that one engine had to say about one file."""

    model: LoadedModel
    poses: tuple[PoseSample, ...] = ()
    rest: tuple[RestMotion, ...] = ()
    fall: Fall = Fall()
    motions: tuple[JointMotion, ...] = ()
    warnings: tuple[str, ...] = ()
    holds: tuple[HoldMotion, ...] = ()


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
        """Return what the engine complained about while moving."""

    def close(self) -> None:
        """Release everything, so that the next world finds the engine as new; then ask no more."""


class Simulator(Protocol):
    """One physics engine; :meth:`open` runs in a killable child process and imports it there.

    Attributes:
        name: how it is chosen, e.g. ``sapien``; also the extra that installs it.
        distribution: the installed package that provides it.
        formats: the description formats it loads: ``urdf``, ``mjcf``.
        soft_friction: formats in which no file can tell it how stiffly joint friction holds.
        blind_spots: sentences: what this engine, as it is used here, cannot see.
    """

    name: str
    distribution: str
    formats: tuple[str, ...]
    soft_friction: tuple[str, ...]
    blind_spots: tuple[str, ...]

    def open(self, path: Path, config: MotionConfig) -> World:
        """Load a file with the base fixed.

        Raises:
            ValueError: with the loader's own words.
        """
