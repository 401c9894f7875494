"""The drive from closed to open and back, the same in every engine: one control law, one force bound."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..config import MotionConfig
from ..description import FloatArray
from .simulator import JointMotion, RestMotion, World

#: A joint without limits is swept through one turn; its sliding cousin has no sweep of its own.
FULL_TURN = 2.0 * math.pi
#: Friction is fed forward in full once the joint lags by this share of its range.
FRICTION_LAG = 0.01
#: An inertia that is no inertia must not make the hand a giant's; no lever of furniture is longer [m].
LONGEST_ARM_M = 1.0


@dataclass(frozen=True)
class Ranges:
    """Where each joint is driven from and to [rad] or [m], shape [joint_count] each."""

    lower: FloatArray
    upper: FloatArray

    @property
    def size(self) -> FloatArray:
        """Upper minus lower; 0 for a joint that is not driven."""
        return self.upper - self.lower


def ranges(world: World) -> Ranges:
    """The drive's ends: the limits; 0 to a full turn without limits; 0 to 0 where there is nothing sensible."""
    lower, upper = [], []
    for joint in world.joints:
        a, b = joint.lower, joint.upper
        if not (math.isfinite(a) and math.isfinite(b)):
            a, b = 0.0, FULL_TURN if joint.kind in ("revolute", "continuous") else 0.0
        lower.append(a)
        upper.append(max(a, b))
    return Ranges(np.array(lower), np.array(upper))


def rest(world: World, config: MotionConfig) -> tuple[RestMotion, ...]:
    """Leave every joint alone at lower, gravity and springs balanced: whatever moves, contact moves it."""
    span = ranges(world)
    world.place(span.lower)
    drift = np.zeros(len(world.joints))
    finite = True
    for _ in range(round(config.rest_s / world.time_step)):
        world.step(world.balance())
        position = world.positions()
        finite = bool(np.isfinite(position).all())
        if not finite:
            break
        drift = np.maximum(drift, np.abs(position - span.lower))
    # Coupled joints may not even be able to be at their lower limits together.
    free = [i for i in range(len(world.joints)) if len(companions(world, i)) == 1]
    return tuple(
        RestMotion(world.joints[i].name, float(drift[i]), _share(drift[i], span.size[i]), finite) for i in free
    )


def sweep(world: World, config: MotionConfig) -> tuple[JointMotion, ...]:
    """Drive every joint in turn, others held lightly at lower; if it fails, again with them at upper.

    Of joints that are forced to move together, one that opens speaks for all: the others may have no way to push it.
    """
    span = ranges(world)
    motions: dict[int, JointMotion] = {}
    for index in np.flatnonzero(span.size > 0.0).tolist():
        motion = drive(world, index, span, "lower", config)
        if len(world.joints) > 1 and not arrived(motion, config):
            again = drive(world, index, span, "upper", config)
            if arrived(again, config):
                motion = again
        motions[index] = motion
    opened = {i for i, motion in motions.items() if arrived(motion, config)}
    return tuple(motion for i, motion in motions.items() if i in opened or not opened & companions(world, i))


def companions(world: World, index: int) -> frozenset[int]:
    """The joint and all that are forced to move with it."""
    pairs = [{joint.name, joint.follows} for joint in world.joints if joint.follows is not None]
    found: set[str | None] = {world.joints[index].name}
    for _ in pairs:
        found |= {name for pair in pairs if pair & found for name in pair}
    return frozenset(i for i, joint in enumerate(world.joints) if joint.name in found)


def arrived(motion: JointMotion, config: MotionConfig) -> bool:
    """Whether the joint went all the way there and back."""
    there = motion.reached >= config.reach_fraction
    return motion.finite and there and motion.returned <= config.return_fraction


def drive(world: World, index: int, span: Ranges, others_at: str, config: MotionConfig) -> JointMotion:
    """Drive one joint from lower to upper and back along a smooth ramp by a bounded force.

    The force is a mass-scaled pull towards the ramp, clipped to a hand's strength, on top of what balances
    gravity and the file's own damping and friction. The other joints are held the same way, but softly.
    """
    start = (span.lower if others_at == "lower" else span.upper).copy()
    start[index] = span.lower[index]
    world.place(start)
    law = _law(world, index, span, config)
    track = _Track(start, index, sorted(companions(world, index)))
    turning_point = config.ramp_s + config.hold_s
    open_enough = span.lower[index] + config.reach_fraction * span.size[index]
    for time in _times(config, world.time_step):
        target, speed, acceleration = _ramp(time, span.lower[index], span.size[index], config)
        goal, goal_speed, goal_acceleration = start.copy(), np.zeros_like(start), np.zeros_like(start)
        goal[index], goal_speed[index], goal_acceleration[index] = target, speed, acceleration
        world.step(law.force(world, goal, goal_speed, goal_acceleration))
        if not track.see(world.positions(), world.velocities()):
            break
        if time >= turning_point and track.highest < open_enough:
            break
    return track.motion(world, span, others_at)


@dataclass(frozen=True)
class _Law:
    inertia: FloatArray
    stiffness: FloatArray
    drag: FloatArray
    damping: FloatArray
    friction: FloatArray
    lag: FloatArray
    bound: FloatArray

    def force(self, world: World, goal: FloatArray, speed: FloatArray, acceleration: FloatArray) -> FloatArray:
        error = goal - world.positions()
        pull = self.inertia * (acceleration + self.stiffness * error + self.drag * (speed - world.velocities()))
        pull += self.damping * speed + self.friction * np.tanh(error / self.lag)
        return np.asarray(np.clip(pull, -self.bound, self.bound) + world.balance(), np.float64)


def _law(world: World, index: int, span: Ranges, config: MotionConfig) -> _Law:
    inertia = world.inertias()
    frequency = np.full(len(inertia), config.hold_frequency)
    frequency[index] = config.drive_frequency
    damping = np.array([joint.damping or 0.0 for joint in world.joints])
    friction = np.array([joint.friction or 0.0 for joint in world.joints])
    swings = np.array([joint.kind != "prismatic" for joint in world.joints])
    arm = np.where(swings, np.sqrt(inertia / np.maximum(world.carried_masses(), 1e-12)), 1.0)
    arm = np.minimum(arm, LONGEST_ARM_M)
    speed = 0.5 * math.pi * span.size / config.ramp_s
    acceleration = speed * math.pi / config.ramp_s
    bound = config.hand_force_n * arm + config.inertia_margin * inertia * acceleration + damping * speed + friction
    # What must move along is not held back.
    bound[sorted(companions(world, index) - {index})] = 0.0
    return _Law(inertia, frequency**2, 2.0 * frequency, damping, friction, FRICTION_LAG * span.size + 1e-6, bound)


def _times(config: MotionConfig, time_step: float) -> FloatArray:
    total = 2.0 * (config.ramp_s + config.hold_s)
    return np.arange(1, round(total / time_step) + 1, dtype=np.float64) * time_step


def _ramp(time: float, lower: float, size: float, config: MotionConfig) -> tuple[float, float, float]:
    back = time - config.ramp_s - config.hold_s
    phase = min(time / config.ramp_s, 1.0) if back < 0.0 else 1.0 + min(back / config.ramp_s, 1.0)
    rate = math.pi / config.ramp_s if phase % 1.0 > 0.0 else 0.0
    position = lower + 0.5 * size * (1.0 - math.cos(math.pi * phase))
    speed = 0.5 * size * rate * math.sin(math.pi * phase)
    acceleration = 0.5 * size * rate**2 * math.cos(math.pi * phase)
    return position, speed, acceleration


class _Track:
    """What was seen of one drive so far."""

    def __init__(self, start: FloatArray, index: int, together: list[int]) -> None:
        self._start, self._index, self._together = start, index, together
        self.highest = self._lowest = self._last = float(start[index])
        self._moved = np.zeros(len(start))
        self._fastest = 0.0
        self._finite = True

    def see(self, position: FloatArray, velocity: FloatArray) -> bool:
        self._finite = bool(np.isfinite(position).all() and np.isfinite(velocity).all())
        if not self._finite:
            return False
        self._last = float(position[self._index])
        self.highest = max(self.highest, self._last)
        self._lowest = min(self._lowest, self._last)
        self._moved = np.maximum(self._moved, np.abs(position - self._start))
        self._fastest = max(self._fastest, abs(float(velocity[self._index])))
        return True

    def motion(self, world: World, span: Ranges, others_at: str) -> JointMotion:
        i, size = self._index, float(span.size[self._index])
        shares = np.array([_share(m, s) for m, s in zip(self._moved, span.size, strict=True)])
        shares[self._together] = 0.0
        most = int(np.argmax(shares))
        return JointMotion(
            joint=world.joints[i].name,
            reached=float(np.clip((self.highest - span.lower[i]) / size, 0.0, 1.0)),
            returned=float(np.clip((self._last - span.lower[i]) / size, 0.0, 1.0)),
            overshoot=max(0.0, self.highest - float(span.upper[i]), float(span.lower[i]) - self._lowest),
            others_moved=float(shares[most]),
            peak_speed=self._fastest,
            finite=self._finite,
            range=size,
            others_at=others_at,
            pushed=world.joints[most].name if shares[most] > 0.0 else None,
        )


def _share(moved: float, size: float) -> float:
    return float(moved / size) if size > 0.0 else 0.0
