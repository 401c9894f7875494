"""Every threshold of the judge, with its unit and the reason for its default."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True)
class PenetrationConfig:
    """How deep parts may lie in one another.

    Attributes:
        rest_m: deepest allowed overlap of two parts with every joint at lower [m].
        excess_m: how much deeper than at rest a pair may get anywhere along a joint's range [m].
        hinge_radius_m: overlaps of the two links of a revolute joint this close to its axis belong to the
            hinge's knuckle and are reported, not rejected [m].
        step_fraction: largest step of the fastest moving point, as a share of the object's diagonal.
    """

    rest_m: float = 0.002
    excess_m: float = 0.001
    hinge_radius_m: float = 0.03
    step_fraction: float = 0.005


@dataclass(frozen=True)
class MotionConfig:
    """The drive from closed to open and back.

    Attributes:
        reach_fraction: share of the range that must be reached.
        return_fraction: share of the range that may be left open after driving back.
        time_step_s: simulation step [s].
        ramp_s, hold_s: time for one way, and for resting at its end [s].
    """

    reach_fraction: float = 0.95
    return_fraction: float = 0.05
    time_step_s: float = 1.0 / 240.0
    ramp_s: float = 0.75
    hold_s: float = 0.25


@dataclass(frozen=True)
class ChildConfig:
    """What a check or a simulator may use before it is killed: wall-clock time [s]."""

    wall_s: float = 120.0


@dataclass(frozen=True)
class CheckConfig:
    """All of the judge's settings."""

    penetration: PenetrationConfig = field(default_factory=PenetrationConfig)
    motion: MotionConfig = field(default_factory=MotionConfig)
    child: ChildConfig = field(default_factory=ChildConfig)
