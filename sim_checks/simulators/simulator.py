"""The one interface behind which every physics engine stands."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from ..config import MotionConfig
from ..description import FloatArray

JointValues = Mapping[str, float]
"""Joint name to value [rad] or [m]."""


@dataclass(frozen=True)
class LoadedLink:
    """A link as the simulator holds it.

    Attributes:
        name: link name.
        mass: [kg]; 0 where the engine holds it as part of the static world.
        shapes: how many collision shapes arrived.
        moments: principal moments of inertia about the centre of mass [kg m2], ascending; ``None`` if static.
        center: centre of mass in the link's frame [m]; ``None`` if static.
        static: the engine never moves it, so its mass and inertia play no part.
    """

    name: str
    mass: float
    shapes: int
    moments: tuple[float, float, float] | None
    center: tuple[float, float, float] | None = None
    static: bool = False


@dataclass(frozen=True)
class LoadedJoint:
    """A joint as the simulator holds it.

    Attributes:
        name: joint name.
        kind: ``revolute``, ``continuous``, ``prismatic``, or the engine's word for anything else; fixed joints
            are not listed, since not every engine keeps them.
        lower, upper: [rad] or [m]; infinite where it has none.
        damping: [N m s/rad] or [N s/m]; ``None`` if the engine has no such property.
        friction: [N m] or [N], as enforced; ``None`` if the engine has no such property.
        follows: the joint that this one is forced to move with (``<mimic>``, MJCF's joint equality).
    """

    name: str
    kind: str
    lower: float
    upper: float
    damping: float | None
    friction: float | None
    follows: str | None = None


@dataclass(frozen=True)
class LoadedModel:
    """Everything a loader kept, and what it said while loading."""

    links: tuple[LoadedLink, ...]
    joints: tuple[LoadedJoint, ...]
    warnings: tuple[str, ...]


@dataclass(frozen=True)
class JointMotion:
    """What one joint did when driven from lower to upper and back.

    Attributes:
        joint: its name.
        reached: highest share of the range reached, 0..1.
        returned: share of the range left open at the end, 0..1; a joint that did not open is not driven back.
        overshoot: furthest beyond a limit [rad] or [m].
        others_moved: largest movement of any other joint, as a share of its own range.
        peak_speed: [rad/s] or [m/s].
        finite: False if a NaN or infinity appeared.
        range: upper minus lower [rad] or [m].
        others_at: where the other joints were held, ``lower`` or ``upper``.
        pushed: the other joint that moved most, if any moved.
    """

    joint: str
    reached: float
    returned: float
    overshoot: float
    others_moved: float
    peak_speed: float
    finite: bool
    range: float = 0.0
    others_at: str = "lower"
    pushed: str | None = None


@dataclass(frozen=True)
class RestMotion:
    """What a joint did when left alone at lower with gravity and springs balanced: any motion is contact pushing.

    Attributes:
        joint: its name.
        drift: furthest from where it started [rad] or [m].
        share: the same as a share of its range.
        finite: False if a NaN or infinity appeared.
    """

    joint: str
    drift: float
    share: float
    finite: bool


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
    motions: tuple[JointMotion, ...] = ()
    warnings: tuple[str, ...] = ()


class World(Protocol):
    """A loaded asset, its base fixed, gravity on, self-collision on, ready to be moved.

    Vectors are ordered as :attr:`joints`.
    """

    @property
    def model(self) -> LoadedModel:
        """What arrived."""

    @property
    def joints(self) -> tuple[LoadedJoint, ...]:
        """The joints that :meth:`step` pushes, all with one degree of freedom."""

    @property
    def time_step(self) -> float:
        """What one :meth:`step` advances [s]."""

    def place(self, positions: FloatArray) -> None:
        """Put the joints there, at rest."""

    def positions(self) -> FloatArray:
        """[rad] or [m], shape [joint_count]."""

    def velocities(self) -> FloatArray:
        """[rad/s] or [m/s], shape [joint_count]."""

    def inertias(self) -> FloatArray:
        """How hard each joint is to accelerate here, the others at rest [kg m2] or [kg], shape [joint_count]."""

    def carried_masses(self) -> FloatArray:
        """Mass that each joint moves [kg], shape [joint_count]."""

    def balance(self) -> FloatArray:
        """Forces that balance gravity, velocity effects and springs here [N m] or [N], shape [joint_count]."""

    def step(self, forces: FloatArray) -> None:
        """One time step with these joint forces [N m] or [N], shape [joint_count]."""

    def link_poses(self) -> dict[str, FloatArray]:
        """Link frames in world here, shape [4, 4] each."""

    def warnings(self) -> tuple[str, ...]:
        """What the engine complained about while moving."""


class Simulator(Protocol):
    """One physics engine. :meth:`open` runs inside a killable child process and imports the engine there."""

    @property
    def name(self) -> str:
        """How it is chosen, e.g. ``sapien``; also the extra that installs it."""

    @property
    def distribution(self) -> str:
        """The installed package that provides it."""

    @property
    def formats(self) -> tuple[str, ...]:
        """Description formats it loads: ``urdf``, ``mjcf``."""

    @property
    def blind_spots(self) -> tuple[str, ...]:
        """Sentences: what this engine, as it is used here, cannot see."""

    def open(self, path: Path, config: MotionConfig) -> World:
        """Load a file with the base fixed.

        Raises:
            ValueError: with the loader's own words.
        """
