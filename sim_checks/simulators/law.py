"""The pull of the hand that drives joints and of those that hold the others."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..config import MotionConfig
from ..description import BoolArray, FloatArray
from .world import World

#: Friction is fed forward in full once the joint lags by this share of its range.
FRICTION_LAG = 0.01
#: An inertia that is no inertia must not make the hand a giant's; no lever of furniture is longer
#: [m].
LONGEST_ARM_M = 1.0
#: What rides on a driven part, this far from its axis [m], may lag by this share of its range, at
#: which it would be taken for pushed; a button, which has a spring, by less. It is held no stiffer
#: than an engine's steps can follow.
RIDING_ARM_M = 2.0
RIDING_SHARE = 0.5
BUTTON_SHARE = 0.2
BUTTON_M = 0.05
RIDING_STEP = 0.3


@dataclass(frozen=True)
class Law:
    """How joints are driven and held, shape [joint_count] each.

    Attributes:
        stiffness, drag: pull back, as accelerations, by how far and how fast joints lag.
        damping, friction: as the engine has them; made up for.
        lag: at which friction is made up for in full [rad] or [m].
        bound: most of it all [N m] or [N].
        coupled: which joints' accelerations count at which, shape [joint_count, joint_count]. What
            hangs loose on a driven part counts for itself: it lags, as a drawer does in a door
            that swings.
    """

    stiffness: FloatArray
    drag: FloatArray
    damping: FloatArray
    friction: FloatArray
    lag: FloatArray
    bound: FloatArray
    coupled: BoolArray

    def pull(
        self,
        mass: FloatArray,
        error: FloatArray,
        speed: FloatArray,
        slip: FloatArray,
        acceleration: FloatArray,
    ) -> FloatArray:
        """Return what the hand adds to the balance [N m] or [N], shape [joint_count].

        Args:
            mass: the mass matrix here, shape [joint_count, joint_count].
            error: how far each joint lags behind where it should be.
            speed: how fast it should be.
            slip: how much slower it is.
            acceleration: how fast it should gain speed.
        """
        wanted = acceleration + self.stiffness * error + self.drag * slip
        pull = np.where(self.coupled, mass, 0.0) @ wanted
        pull += self.damping * speed + self.friction * np.tanh(error / self.lag)
        return np.minimum(np.maximum(pull, -self.bound), self.bound)


def drive_law(world: World, mass: FloatArray, indices: Sequence[int], config: MotionConfig) -> Law:
    """Return how to drive some joints and to hold all others softly.

    The mass matrix is that at the start, shape [joint_count, joint_count].
    """
    span = world.span
    frequency = np.full(len(mass), config.hold_frequency)
    damping = np.array([joint.damping or 0.0 for joint in world.joints])
    friction = np.array([joint.friction or 0.0 for joint in world.joints])
    # What a hand has for each joint alone beyond its friction.
    inertia = np.diag(mass)
    slides = np.array([joint.kind == "prismatic" for joint in world.joints])
    arm = np.sqrt(inertia / np.maximum(world.carried_masses, 1e-12))
    arm = np.where(slides, 1.0, np.minimum(arm, LONGEST_ARM_M))
    peaks = 0.5 * span.size * (math.pi / config.ramp_s) ** 2
    bound = config.hand_force_n * arm + config.inertia_margin * inertia * peaks
    speeds = 0.5 * math.pi * span.size / config.ramp_s
    bound += damping * speeds
    coupled = np.ones(mass.shape, dtype=bool)
    for index in indices:
        peak = float(peaks[index])
        # The motion of one joint takes forces at those that carry it.
        passed_on = config.inertia_margin * np.abs(mass[:, index]) * peak
        passed_on[index] = 0.0
        bound += passed_on
        # The joints with a range that this one carries.
        inner = (i for i, carried in enumerate(world.carried) if carried < world.carried[index])
        for other in (i for i in inner if span.size[i] > 0.0):
            ride = peak * (RIDING_ARM_M if slides[other] else 1.0)
            size = float(span.size[other])
            stiff = math.sqrt(ride / ((BUTTON_SHARE if size < BUTTON_M else RIDING_SHARE) * size))
            frequency[other] = max(frequency[other], min(stiff, RIDING_STEP / world.time_step))
            # Enough for the ride, so that what presses it still moves it.
            bound[other] = max(config.inertia_margin * mass[other, other] * ride, passed_on[other])
            if _hangs_loose(world, index, other):
                coupled[other] = coupled[:, other] = False
        frequency[index] = config.drive_frequency
    bound += friction
    for index in indices:
        # What must move along is not held back.
        along = sorted(world.companions(index) - {index})
        bound[along] = frequency[along] = 0.0
    np.fill_diagonal(coupled, val=True)
    lag = FRICTION_LAG * span.size + 1e-6
    return Law(frequency**2, 2.0 * frequency, damping, friction, lag, bound, coupled)


def _hangs_loose(world: World, index: int, other: int) -> bool:
    """Return whether one joint carries another, that one carries none, and no third is involved.

    In longer chains a joint that nobody accelerates with the rest is shaken like a whip.
    """
    inner = world.carried[other]
    outer = world.carried[index]
    between = [each for each in world.carried if inner < each or each < inner]
    return between == [outer] and not any(outer < each for each in world.carried)
