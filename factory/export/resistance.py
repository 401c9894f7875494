"""How hard a joint is to move, where nobody has said so.

A joint without friction swings open at the slightest touch; one that a robot arm cannot open is no
use either. The defaults aim at furniture: one or two newtons at the rim start a motion, and a door
that was pushed comes to rest within about a second.

==========  =======================================================================================
friction    revolute: ``clip(0.03 m g, 0.5 N, 3 N) * r`` [N m], r the reach of the moving part from
            the axis; prismatic: ``clip(0.03 m g, 1 N, 5 N)`` [N]. Never less than 1.2 times what
            gravity pulls the closed joint open with, so that a closed oven door stays closed; but
            never more than 20 N at the rim: what takes more to hold hangs on a spring or a latch.
damping     ``I / 0.5 s`` [N m s/rad] or ``m / 0.5 s`` [N s/m]: free motion halves every 0.35 s;
            opening in 3 s never takes more than 20 N at the rim.
armature    ``0.01 I`` or ``0.01 m``, in MuJoCo only: steadies thin parts, changes motion by one
            percent.
==========  =======================================================================================

Damping that was stated is lowered to ``I / 8.3 ms`` if it is more: Bullet integrates it explicitly,
so that at its 240 Hz more than half of a motion's speed may not go in one step. Nor may it take
more than 30 N at the rim to open the joint in 3 s; the same holds for stated friction. Friction of
more than 300 N at the rim counts as not stated. All friction is at most what stops the joint from
half of Bullet's greatest speed, 100 rad/s or m/s, in one step: Bullet cuts speeds to that before
friction acts, so that no force at all moves a joint whose friction is more (a flap of 5 g).

m and I are those of the child and everything it carries, I about the joint's axis at rest.

PhysX's own joint friction (SAPIEN's ``joint.set_friction``) is none of these: it is a bare
coefficient on the joint's load. Measured on a level drawer of 2 kg, 0.05 holds 1.1 N and 0.1 holds
2.2 N; on a door it follows the bending moment at the hinge, so that one value holds anything from
nothing to everything.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..articulation import Joint
from ..asset import Asset
from ..mesh import FloatArray

GRAVITY = 9.81
WEIGHT_SHARE = 0.03
RIM_FORCE_N = (0.5, 3.0)
SLIDE_FORCE_N = (1.0, 5.0)
HOLD_CLOSED = 1.2
REST_TIME_S = 0.5
ARMATURE_SHARE = 0.01
#: Two steps of 1/240 s [s].
SHORTEST_TIME_S = 2.0 / 240.0
#: Half of Bullet's greatest speed in a step of 1/240 s [rad/s2] or [m/s2].
HARDEST_STOP = 0.5 * 100.0 * 240.0
#: The most that is chosen here, for a light hand [N].
CHOSEN_RIM_FORCE_N = 20.0
#: The most that is kept of what was stated, what a robot's arm can pull [N], and the time that it
#: may take [s].
MOST_RIM_FORCE_N = 30.0
OPENING_TIME_S = 3.0
#: Stated friction of this many times what an arm can pull means something else: a lock, a mistake.
LOCKED = 10.0


@dataclass(frozen=True)
class Resistance:
    """What a joint sets against motion.

    Attributes:
        inertia: of the child and all it carries, about the joint's axis [kg m2] or along it [kg].
        damping: [N m s/rad] or [N s/m].
        friction: [N m] or [N].
    """

    inertia: float
    damping: float
    friction: float

    @property
    def armature(self) -> float:
        """Return the addition to ``inertia`` in MuJoCo [kg m2] or [kg]."""
        return ARMATURE_SHARE * self.inertia


#: Of a fixed joint.
NO_RESISTANCE = Resistance(0.0, 0.0, 0.0)


def joint_resistances(asset: Asset) -> tuple[Resistance, ...]:
    """Return one per joint; stated values win if engines bear them, 0 for fixed joints."""
    articulation = asset.articulation
    closed = articulation.poses({joint.name: joint.lower for joint in articulation.joints})
    return tuple(_resistance(asset, joint, closed) for joint in articulation.joints)


def resistance_notes(asset: Asset, resistances: tuple[Resistance, ...]) -> tuple[str, ...]:
    """Return which stated friction and damping was lowered, a sentence each."""
    notes = []
    for joint, resistance in zip(asset.articulation.joints, resistances, strict=True):
        for word, stated, written in (
            ("friction", joint.friction, resistance.friction),
            ("damping", joint.damping, resistance.damping),
        ):
            if joint.movable and stated is not None and written < stated:
                more = "is more than an arm can pull or an engine integrate"
                said = f"{word} {stated:.3g} {more}; {written:.3g} was written"
                notes.append(f"joint {joint.name!r}: {said}")
    return tuple(notes)


def _resistance(asset: Asset, joint: Joint, closed: FloatArray) -> Resistance:
    if not joint.movable:
        return NO_RESISTANCE
    carried = asset.articulation.carried(joint.child)
    mass = sum(asset.bodies[part].inertial.mass for part in carried)
    weight = WEIGHT_SHARE * mass * GRAVITY
    if joint.turns:
        inertia = sum(_inertia_about(asset, part, joint) for part in carried)
        reach = _reach(asset, carried, joint, (inertia / mass) ** 0.5)
        friction = float(np.clip(weight, *RIM_FORCE_N)) * reach
    else:
        inertia = mass
        reach = 1.0
        friction = float(np.clip(weight, *SLIDE_FORCE_N))
    friction = max(friction, HOLD_CLOSED * _gravity_opens(asset, carried, joint, closed))
    friction = min(friction, CHOSEN_RIM_FORCE_N * reach)
    most = MOST_RIM_FORCE_N * reach
    # More than that is a lock rather than a friction.
    if joint.friction is not None and joint.friction <= LOCKED * most:
        friction = min(joint.friction, most)
    return Resistance(
        inertia=inertia,
        damping=_damping(joint, inertia, reach),
        friction=min(friction, HARDEST_STOP * inertia),
    )


def _damping(joint: Joint, inertia: float, reach: float) -> float:
    """Return the damping that hands and engines bear, stated or chosen [N m s/rad, N s/m]."""
    damping = inertia / REST_TIME_S if joint.damping is None else joint.damping
    pull = CHOSEN_RIM_FORCE_N if joint.damping is None else MOST_RIM_FORCE_N
    speed = (joint.upper - joint.lower) / OPENING_TIME_S
    most = pull * reach / speed if speed > 0.0 else damping
    return min(damping, inertia / SHORTEST_TIME_S, most)


def _inertia_about(asset: Asset, part: int, joint: Joint) -> float:
    inertial = asset.bodies[part].inertial
    arm = np.cross(joint.axis, inertial.center - joint.origin)
    return float(joint.axis @ inertial.tensor @ joint.axis + inertial.mass * (arm @ arm))


def _reach(asset: Asset, carried: tuple[int, ...], joint: Joint, otherwise: float) -> float:
    corners = [hull.vertices for part in carried for hull in asset.bodies[part].hulls]
    if not corners:
        return otherwise
    arms = np.cross(joint.axis, np.concatenate(corners) - joint.origin)
    return float(np.linalg.norm(arms, axis=1).max())


def _gravity_opens(
    asset: Asset, carried: tuple[int, ...], joint: Joint, closed: FloatArray
) -> float:
    """Return the gravity force that opens, every joint at lower [N m] or [N]; at least 0."""
    frame = closed[joint.parent]
    axis = frame[:3, :3] @ joint.axis
    origin = frame[:3, :3] @ joint.origin + frame[:3, 3]
    total = 0.0
    for part in carried:
        inertial = asset.bodies[part].inertial
        center = closed[part][:3, :3] @ inertial.center + closed[part][:3, 3]
        direction = np.cross(axis, center - origin) if joint.turns else axis
        total -= inertial.mass * GRAVITY * direction[2]
    return max(0.0, float(total))
