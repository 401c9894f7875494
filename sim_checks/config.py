"""Every threshold of the judge, with its unit and the reason for its default."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True)
class PenetrationConfig:
    """How deep parts may lie in one another.

    Attributes:
        rest_m: deepest allowed overlap of two parts with every joint at lower [m]. Contact solvers push overlapping
            bodies apart; from about 2 mm on, drawers start to jam and doors to spring open.
        excess_m: how much deeper than at rest a pair may get anywhere along a joint's range [m]; smaller than
            ``rest_m``, because depth that grows along the way is what stops a joint.
        hinge_radius_m: overlaps of the two links of a revolute joint this close to its axis may belong to the
            hinge's knuckle and are then reported, not rejected [m]. A 12 mm knuckle was measured to need 22 mm.
        hinge_share: largest share of the moving part's length along the hinge that knuckles may take together.
        step_fraction: step of the fastest moving point from which the search along a joint starts, as a share of
            the object's diagonal; the search refines it wherever it is not certain.
        clearance_m: gaps wider than this are not measured [m].
        combinations: joint combinations tried besides "all at upper".
    """

    rest_m: float = 0.002
    excess_m: float = 0.001
    hinge_radius_m: float = 0.03
    hinge_share: float = 0.5
    step_fraction: float = 0.005
    clearance_m: float = 0.005
    combinations: int = 8


@dataclass(frozen=True)
class MotionConfig:
    """The drive from closed to open and back, and what it may show.

    Attributes:
        reach_fraction: share of the range that must be reached.
        return_fraction: share of the range that may be left open after driving back.
        time_step_s: simulation step [s]; 1/240 is what robot-learning environments commonly run at.
        ramp_s, hold_s: time for one way, and for resting at its end [s].
        rest_s: how long the joints are left alone at lower with gravity balanced [s].
        hand_force_n: pull that a joint must open under, beyond gravity, friction and the part's own inertia [N];
            at a revolute joint it pulls at the radius of gyration. Twenty newtons is a light hand.
        inertia_margin: the bound also holds this many times what accelerating the part along the ramp needs.
        drive_frequency, hold_frequency: stiffness of the drive of the joint in motion and of the light hold of
            the others, as the natural frequency of the part on it [rad/s]; critically damped.
        others_soft, others_hard: share of its own range by which another joint may be pushed along.
        overshoot_soft, overshoot_hard: share of its range by which a joint may pass its limit. Engines with soft
            limits pass theirs by up to a few percent.
        drift_soft, drift_hard: share of its range by which contact alone may push a resting joint open.
        parents_touch: let parent and child link touch in the engines that can.
    """

    reach_fraction: float = 0.95
    return_fraction: float = 0.05
    time_step_s: float = 1.0 / 240.0
    ramp_s: float = 0.75
    hold_s: float = 0.25
    rest_s: float = 0.5
    hand_force_n: float = 20.0
    inertia_margin: float = 2.0
    drive_frequency: float = 40.0
    hold_frequency: float = 10.0
    others_soft: float = 0.05
    others_hard: float = 0.5
    overshoot_soft: float = 0.02
    overshoot_hard: float = 0.2
    drift_soft: float = 0.02
    drift_hard: float = 0.1
    parents_touch: bool = True


@dataclass(frozen=True)
class LoadingConfig:
    """How closely a simulator must hold what the file says.

    Attributes:
        limit: joint limits [rad] or [m]; engines hold single precision.
        mass, inertia: relative difference of masses and principal moments.
        moment_floor: differences of principal moments below this are never held against anyone [kg m2].
        position_m, angle_rad: link poses against our own kinematics.
    """

    limit: float = 1e-6
    mass: float = 1e-4
    inertia: float = 1e-3
    moment_floor: float = 1e-9
    position_m: float = 1e-5
    angle_rad: float = 1e-4


@dataclass(frozen=True)
class LintConfig:
    """What a sound file looks like.

    Attributes:
        hulls_per_link: more collision shapes than this on a link are reported; GPU simulation allows 64.
        hull_vertices: more corners than this on a hull are reported; GPU simulation allows 64.
        hull_aspect: longest over shortest extent of a hull from which it is reported; PhysX on the GPU rejects
            oblong hulls from about this on.
        convexity: a collision mesh whose hull is this much larger than its own volume is not what engines take.
        gap_share: collision and visual surfaces further apart than this share of the link's diagonal are reported.
        gap_m: but never below this [m].
        offset_share: collision geometry that lies shifted against the visual by more than this share of the link's
            diagonal rejects.
        samples: points on each surface for these distances.
        density_low, density_high: mass over collision volume outside these is reported [kg/m3]: air is 1.2, lead
            11000; a solid hull around a hollow thing weighs little.
        gyration_share: a radius of gyration above this share of the link's diagonal is reported; a uniform rod,
            the extreme, has 0.29.
    """

    hulls_per_link: int = 64
    hull_vertices: int = 64
    hull_aspect: float = 64.0
    convexity: float = 1.05
    gap_share: float = 0.05
    gap_m: float = 0.01
    offset_share: float = 0.1
    samples: int = 500
    density_low: float = 5.0
    density_high: float = 12000.0
    gyration_share: float = 0.5


@dataclass(frozen=True)
class ChildConfig:
    """What a check or a simulator may use before it is killed: wall-clock time [s]."""

    wall_s: float = 120.0


@dataclass(frozen=True)
class CheckConfig:
    """All of the judge's settings."""

    lint: LintConfig = field(default_factory=LintConfig)
    penetration: PenetrationConfig = field(default_factory=PenetrationConfig)
    loading: LoadingConfig = field(default_factory=LoadingConfig)
    motion: MotionConfig = field(default_factory=MotionConfig)
    child: ChildConfig = field(default_factory=ChildConfig)
