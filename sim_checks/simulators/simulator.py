"""One physics engine, and all that it saw of one file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from ..config import MotionConfig
from ..description import FloatArray
from .world import LoadedModel, World

JointValues = Mapping[str, float]
"""Joint name to value [rad] or [m]."""


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
    """All that one engine had to say about one file: its loader, and itself while things moved."""

    model: LoadedModel
    poses: tuple[PoseSample, ...] = ()
    rest: tuple[RestMotion, ...] = ()
    fall: Fall = Fall()
    motions: tuple[JointMotion, ...] = ()
    warnings: tuple[str, ...] = ()
    holds: tuple[HoldMotion, ...] = ()
    loader_lines: tuple[str, ...] = ()


class Simulator(Protocol):
    """One physics engine; :meth:`open` runs in a killable child process and imports it there.

    Attributes:
        name: how it is chosen, e.g. ``sapien``; also the extra that installs it.
        distribution: the installed package that provides it.
        formats: the description formats it loads: ``urdf``, ``mjcf``.
        soft_friction: formats in which no file can tell it how stiffly joint friction holds.
        friction_advice: what makes joint friction stiffer in the others, after a semicolon.
        blind_spots: sentences: what this engine, as it is used here, cannot see.
    """

    name: str
    distribution: str
    formats: tuple[str, ...]
    soft_friction: tuple[str, ...] = ()
    friction_advice: str = ""
    blind_spots: tuple[str, ...]

    def open(self, path: Path, config: MotionConfig) -> World:
        """Load a file with the base fixed.

        Raises:
            ValueError: with the loader's own words.
        """
