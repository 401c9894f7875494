"""Every threshold of the checks, with its unit and the reason for its default."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from .processes.isolation import Limits

#: Metadata of settings that limit time or memory: they decide by failing, not what is measured.
LIMIT = "limit"


@dataclass(frozen=True)
class PenetrationConfig:
    """How deep parts may penetrate each other.

    Attributes:
        rest_m: deepest allowed overlap of two parts with every joint at lower [m]. Contact solvers
            push overlapping bodies apart; from about 2 mm on, drawers start to jam and doors to
            spring open.
        excess_m: how much deeper than at rest a pair may get anywhere along a joint's range [m];
            smaller than ``rest_m``, because depth that grows along the way is what stops a joint.
        hinge_radius_m: overlaps of the two links of a revolute joint this close to its axis may
            belong to the hinge's knuckle and are then reported, not rejected [m]. A 12 mm knuckle
            was measured to need 22 mm.
        hinge_share: largest share of the moving part's length along the hinge that knuckles may
            take together.
        step_fraction: step of the fastest moving point from which the search along a joint starts,
            as a share of the object's diagonal; the search refines it wherever it is not certain.
        clearance_m: gaps wider than this are not measured, of hulls or of visible surfaces [m].
        combinations: joint combinations tried besides "all at upper".
        little_open: share of its range at which a joint is a little open. Where another cannot
            reach its range with it there, and wherever further open it is tried, the asset is
            rejected: 10 % of a drawer is 4 cm, which whoever opens the other does not see.
        pair_looks: exact looks that pairs of joints swept together may take of one file; pairs
            that are then left out are told.
    """

    rest_m: float = 0.002
    excess_m: float = 0.001
    hinge_radius_m: float = 0.03
    hinge_share: float = 0.5
    step_fraction: float = 0.005
    clearance_m: float = 0.005
    combinations: int = 8
    little_open: float = 0.1
    pair_looks: int = 20_000


@dataclass(frozen=True)
class MotionConfig:
    """The drive from closed to open and back, and what it may show.

    Attributes:
        reach_fraction: share of the range that must be reached.
        return_fraction: share of the range that may be left open after driving back.
        time_step_s: simulation step [s]; 1/240 is what robot-learning environments commonly run at.
        ramp_s, hold_s: time for one way, and for resting at its end [s].
        rest_s: how long the joints are left alone at lower, once without gravity and once with it
            [s].
        still_s, still_share: the wait ends early once no joint was faster than this share of its
            range per second for that long [s], and none is getting faster. Whatever pushes steadily
            and stays below that speed for half a second moves its joint by less than a tenth of
            ``drift_soft`` in three.
        release_s: how long the joints are watched after the hand has let go of one [s].
        hand_force_n: pull that a joint must open under, beyond gravity, friction and the part's own
            inertia [N]; at a revolute joint it pulls at the radius of gyration. Twenty newtons is a
            light hand.
        inertia_margin: the bound also holds this many times what accelerating the part along the
            ramp needs.
        drive_frequency, hold_frequency: stiffness of the drive of the joint in motion and of the
            light hold of the others, as the natural frequency of the part on it [rad/s]; critically
            damped.
        others_soft, others_hard: share of its own range by which another joint may be pushed along.
        overshoot_soft, overshoot_hard: share of its range by which a joint may pass its limit.
            Engines with soft limits pass theirs by up to a few percent.
        drift_soft, drift_hard: share of its range by which contact alone may push a resting joint
            open.
        fall_soft: share of its range that a joint may open under its own weight unmentioned.
        held_s: how long a joint that friction should hold is left alone, at three values of its
            range [s].
        hold_share: friction should hold a joint whose load, by the description's masses, is at
            most this share of it. Friction of 1.01 times the load was measured to hold in PyBullet,
            and to creep no further in MuJoCo than friction of twice the load.
        creep_share, creep_m, creep_rad: a joint that is held and moves further than this share of
            its range, and in any case further than this [m] or [rad], creeps. Someone who looks
            away for the two seconds sees no difference below; MuJoCo's default friction creeps by
            20 mm and, at an arm of 0.3 m, 0.05 rad, and its stiffest by 0.02 mm and 5e-5 rad.
        energy_soft_m, energy_hard_m: energy that nothing gave, as the height to which it would
            lift moving links [m]: speeds of 1 m/s, faster than a hand opens a drawer, and of
            2 m/s, faster than it ever does. MuJoCo and PyBullet were measured to give them to
            blocks that overlap by 5 cm and by 10 cm.
        energy_floor_j: less than this is never held against anyone [J].
        parents_touch: let parent and child link touch in the engines that can.
    """

    reach_fraction: float = 0.95
    return_fraction: float = 0.05
    time_step_s: float = 1.0 / 240.0
    ramp_s: float = 0.75
    hold_s: float = 0.25
    rest_s: float = 3.0
    still_s: float = 0.5
    still_share: float = 2e-4
    release_s: float = 0.25
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
    fall_soft: float = 0.05
    held_s: float = 2.0
    hold_share: float = 0.9
    creep_share: float = 0.05
    creep_m: float = 0.001
    creep_rad: float = 0.01
    energy_soft_m: float = 0.05
    energy_hard_m: float = 0.2
    energy_floor_j: float = 0.01
    parents_touch: bool = True


@dataclass(frozen=True)
class LoadingConfig:
    """How closely a simulator must hold what the file says.

    Attributes:
        limit: joint limits [rad] or [m]; engines hold single precision.
        mass, inertia: relative difference of masses and principal moments.
        moment_floor: differences of principal moments below this are never held against anyone [kg
            m2].
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
        hulls_per_link: more collision shapes than this on a link are reported; GPU simulation
            allows 64.
        hull_vertices: more corners than this on a hull are reported; GPU simulation allows 64.
        most_vertices: more corners than this reject: engines cook such a hull down to a few hundred
            corners, each to others, and the checks measure one thinned to a few thousand.
        hull_aspect: longest over shortest extent of a hull from which it is reported; PhysX on the
            GPU rejects oblong hulls from about this on.
        convexity: a collision mesh whose hull is this much larger than its own volume is not what
            engines take.
        gap_share: collision and visual surfaces further apart than this share of the link's
            diagonal are reported.
        gap_m: but never below this [m].
        least_covered: share of a link's visible surface that must lie within ``gap_m`` of its
            collision geometry; a link of which less can be touched rejects.
        offset_share: collision geometry that lies shifted against the visual by more than this
            share of the link's diagonal rejects.
        scale_share: collision geometry whose box is smaller than this share of the visible one, or
            as many times larger, rejects; a file in millimetres beside one in metres is a thousand
            times off.
        samples: points on each surface for these distances.
        density_low, density_high: mass over collision volume outside these is reported [kg/m3]: air
            is 1.2, lead 11000; a solid hull around a hollow thing weighs little.
        density_least, density_most: outside these rejects [kg/m3]; less than a twentieth of air,
            more than osmium, the densest material. For ``density_most`` the volume is the larger of
            the hulls' and of what the visible surfaces enclose, so that hulls cut back from the
            visible shape condemn nothing.
        sheet_m: visible surfaces are at least this thick [m] in that volume: thin metal.
        center_soft, center_hard, center_m: a centre of mass further outside the box of its link
            than the first share of the box's diagonal is reported; further than the second and than
            ``center_m`` [m] it rejects. Mass lies within a body; a mesh that leaves out a motor or
            a leg does not move its centre by a tenth of the whole.
        axis_slack: an axis may differ from length 1 by this; further off, which rejects, engines
            move a slide by different lengths, and a reader that takes it for a unit vector turns a
            hinge by another angle.
        gyration_share: a radius of gyration above this share of the link's diagonal is reported; a
            uniform rod, the extreme, has 0.29. Mass spread further along an axis than half the
            link's extent, with the slack of its centre, rejects: two points at its ends have that.
        slide_share: a slide longer than this many diagonals of the object rejects; the longest
            drawers travel less than one.
        turns: a revolute joint of more turns than this rejects: degrees written as radians, mostly.
        tiny_slide_m, tiny_turn_rad: shorter ranges are reported: they open nothing, and lie within
            the tolerances of every engine.
        axis_soft, axis_hard: a hinge axis further than this many diagonals of what it moves, both
            from that and from the rest of the object, is reported, or rejects. A hinge is fastened
            to something; linkages that are written as one joint have their axis within a diagonal.
        oblique_deg: a hinge further off every edge of a box that it turns rejects [deg]. Of 1,820
            hinges that others made none is more than 1 off.
        apart: what a joint moves may lie this many times the larger of its own and the rest's
            diagonal away from the rest; further off, the two are no one object.
        finger_m: a slide comes this near to what carries it in some pose, and a hinge in each, a
            finger's width, or it is fastened to nothing [m].
        near_share: of the part's diagonal that is near enough as well, beside that width: racks
            ride on rails that no mesh has, and thick doors that turn about an edge leave 5 %.
        pull_soft_n, pull_hard_n: a joint whose friction, or damping when opened in ``opening_s``
            [s], takes more force at the far edge than this is reported, or rejects [N]. Arms of
            robots pull some 30 N; a stiff fridge takes 60; with more than 100 N not even a person
            opens it.
        damping_step: damping that takes more than this share of the speed in one step is reported.
        voxels, voxel_m: the open inside of a link is measured in this many voxels along its longest
            side, none smaller than this [m].
        cavity_share, pocket_share: space smaller than this share of the link's convex hull is no
            cavity, or no pocket, worth speaking of: gaps behind handles, recessed panels.
        hand_m: a pocket is where a ball of this diameter [m], a hand, gets in and has its centre.
        pocket_kept, interior_kept: share that collision shapes must leave free of a pocket (error)
            and of all free space within the link's outline (warning).
    """

    hulls_per_link: int = 64
    hull_vertices: int = 64
    most_vertices: int = 4000
    hull_aspect: float = 64.0
    convexity: float = 1.05
    gap_share: float = 0.05
    gap_m: float = 0.01
    least_covered: float = 0.9
    offset_share: float = 0.1
    scale_share: float = 0.1
    samples: int = 500
    density_low: float = 5.0
    density_high: float = 12000.0
    density_least: float = 0.05
    density_most: float = 22600.0
    sheet_m: float = 0.001
    center_soft: float = 0.05
    center_hard: float = 0.1
    center_m: float = 0.01
    axis_slack: float = 0.01
    gyration_share: float = 0.5
    slide_share: float = 2.0
    turns: float = 2.0
    tiny_slide_m: float = 0.001
    tiny_turn_rad: float = math.radians(0.5)
    axis_soft: float = 1.0
    axis_hard: float = 2.0
    oblique_deg: float = 3.0
    apart: float = 1.0
    finger_m: float = 0.02
    near_share: float = 0.1
    pull_soft_n: float = 30.0
    pull_hard_n: float = 100.0
    opening_s: float = 3.0
    damping_step: float = 1.0
    voxels: int = 64
    voxel_m: float = 0.002
    cavity_share: float = 0.1
    pocket_share: float = 0.05
    hand_m: float = 0.06
    pocket_kept: float = 0.5
    interior_kept: float = 0.5


@dataclass(frozen=True)
class StandingConfig:
    """When an object that rests on the floor, fastened to nothing, counts as standing.

    Attributes:
        margin_m: how far inside its support the centre of mass must lie [m].
        contact_share, contact_m: points no higher above the lowest one than this share of the
            object's diagonal along the floor, and in any case this [m], touch the floor: an uneven
            underside settles, leaning by a fraction of a degree.
        footing_m: a support narrower than this is a line or a point, on which nothing stands [m].
        hand_force_n: pull that must not tip it [N]; as strong as the hand that opens joints.
    """

    margin_m: float = 0.005
    contact_share: float = 0.005
    contact_m: float = 0.001
    footing_m: float = 0.005
    hand_force_n: float = 20.0


@dataclass(frozen=True)
class ChildConfig:
    """What a check or a simulator may use before it is killed, and how long one child is kept.

    Attributes:
        wall_s: wall-clock time for one file [s].
        memory_bytes: address space [bytes]. Every engine and the static checks were measured to
            reserve 0.3 to 0.6 GB on two processors, of which they use 0.1; linear algebra reserves
            some 0.05 GB more for each further processor. Only an asset that makes an engine
            allocate without end comes near this.
        calls: files after which a child is replaced: native libraries leak a little with every
            file.
        resident_bytes: memory held after a file from which a child is replaced at once [bytes].
    """

    wall_s: float = 120.0
    memory_bytes: int = 8 * 2**30
    calls: int = 200
    resident_bytes: int = 2**30

    @property
    def limits(self) -> Limits:
        """Return the limits for one file."""
        return Limits(self.wall_s, memory_bytes=self.memory_bytes)


@dataclass(frozen=True)
class WorkConfig:
    """How much work one file may take; beyond it there is no verdict (``too_large_to_judge``).

    Counted, so that every machine comes to the same end. The largest real object tried, a keyboard
    of 116 keys, takes a tenth of ``looks`` and two thirds of ``driven_links``.

    Attributes:
        hulls: collision shapes of all links together: boxes around all of them are compared.
        moved_links: links that joints move, counted once for each joint: a keyboard's keys once
            each, a chain of 300 links 45,000 times.
        looks: exact looks at two hulls, at rest and along all joints.
        driven_links: joints that a simulator drives times links of the model, all of which it moves
            in every step.
    """

    hulls: int = 4000
    moved_links: int = 50_000
    looks: int = 100_000
    driven_links: int = 20_000


@dataclass(frozen=True)
class CheckConfig:
    """All settings of the checks."""

    lint: LintConfig = field(default_factory=LintConfig)
    standing: StandingConfig = field(default_factory=StandingConfig)
    penetration: PenetrationConfig = field(default_factory=PenetrationConfig)
    loading: LoadingConfig = field(default_factory=LoadingConfig)
    motion: MotionConfig = field(default_factory=MotionConfig)
    work: WorkConfig = field(default_factory=WorkConfig)
    child: ChildConfig = field(default_factory=ChildConfig, metadata={LIMIT: True})
