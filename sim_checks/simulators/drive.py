"""The drive from closed to open and back: one control law and force bound for every engine."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from ..config import MotionConfig
from ..description import FloatArray
from .joints import Ranges, carried_masses, companions, ranges, share
from .rest import Gain, let_go
from .simulator import JointMotion, World
from .touching import pressing

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
#: How often the joints that make way are added to, because another link stands behind them.
WIDENED = 3

Joints = frozenset[int]
CLOSED: Joints = frozenset()


def sweep(world: World, config: MotionConfig) -> tuple[JointMotion, ...]:
    """Drive every joint, others held lightly at lower; if it fails, again with some opened.

    Only joints that have opened themselves in this world make way, together with those that they
    needed for it: two joints that bar each other never open. Of joints that are forced to move
    together, one that opens speaks for all: the others may have no way to push it.
    """
    order = _Order(world, ranges(world), config)
    order.settle()
    opened = {index for index, motion in order.motions.items() if arrived(motion, config)}
    return tuple(
        motion
        for i, motion in order.motions.items()
        if i in opened or not opened & companions(world, i)
    )


class _Order:
    """Which joints open, and which others must be open for it."""

    def __init__(self, world: World, span: Ranges, config: MotionConfig) -> None:
        self._world = world
        self._span = span
        self._config = config
        driven = np.flatnonzero(span.size > 0.0).tolist()
        self._driven: dict[tuple[int, Joints], JointMotion] = {}
        self.motions = {index: self._drive(index, CLOSED) for index in driven}
        self.needs = {
            index: CLOSED for index, motion in self.motions.items() if opens(motion, config)
        }

    def settle(self) -> None:
        """Let joints open until no further one does."""
        while self._freed(self._makers) or self._freed(self._all):
            pass

    def _freed(self, trials: Callable[[int], Iterator[Joints]]) -> bool:
        """Try every blocked joint with others open; whether one opens that did not before."""
        found: dict[int, Joints] = {}
        for index in sorted(self.motions.keys() - self.needs.keys()):
            for opened in trials(index):
                motion = self._drive(index, opened)
                if opens(motion, self._config):
                    found[index] = opened
                    self.motions[index] = motion
                    break
                if arrived(motion, self._config) and not arrived(self.motions[index], self._config):
                    self.motions[index] = motion
        self.needs.update(found)
        return bool(found)

    def _drive(self, index: int, opened: Joints) -> JointMotion:
        """Drive a joint with others open, once."""
        if (index, opened) not in self._driven:
            self._driven[index, opened] = drive(
                self._world, index, self._span, opened, self._config
            )
        return self._driven[index, opened]

    def _makers(self, index: int) -> Iterator[Joints]:
        """The joints that move one of two links in contact, or were pushed; more as others join.

        Each alone before all of them: a lid makes way, and what unfolds the whole box does not.
        """
        opened = CLOSED
        for _ in range(WIDENED):
            motion = self._drive(index, opened)
            makers = self._ready(index) & self._in_the_way(motion)
            for maker in sorted(makers - opened, key=lambda i: (not self._leans(motion, i), i)):
                yield opened.union({maker}, self.needs[maker])
            wider = opened.union(makers, *(self.needs[maker] for maker in makers))
            if wider == opened:
                return
            opened = wider
            yield opened

    def _leans(self, motion: JointMotion, index: int) -> bool:
        """Return whether this is the joint that was pushed most."""
        return self._world.joints[index].name == motion.pushed

    def _in_the_way(self, motion: JointMotion) -> Joints:
        world = self._world
        if motion.blocked_by is None:
            return frozenset(
                i for i, joint in enumerate(world.joints) if joint.name == motion.pushed
            )
        one, two = motion.blocked_by
        return frozenset(
            i for i, carried in enumerate(world.carried) if (one in carried) != (two in carried)
        )

    def _all(self, index: int) -> Iterator[Joints]:
        """Yield what presses hardest need not be what is in the way."""
        yield self._ready(index)

    def _ready(self, index: int) -> Joints:
        return frozenset(self.needs) - companions(self._world, index)


def arrived(motion: JointMotion, config: MotionConfig) -> bool:
    """Return whether the joint went all the way there and back."""
    there = motion.reached >= config.reach_fraction
    return motion.finite and there and motion.returned <= config.return_fraction


def opens(motion: JointMotion, config: MotionConfig) -> bool:
    """Return whether it did without pushing another open: that other has to open first."""
    return arrived(motion, config) and motion.others_moved <= config.others_hard


def drive(
    world: World, index: int, span: Ranges, opened: Joints, config: MotionConfig
) -> JointMotion:
    """Drive one joint from lower to upper and back by a bounded force, then let go.

    It follows a smooth ramp. The force is a mass-scaled pull towards the ramp, clipped to a hand's
    strength, on top of what balances gravity and the file's own damping and friction. The other
    joints are held the same way, but softly: those in ``opened`` at upper, the rest at lower. What
    rides on the part that is driven, a button on a door, is held so that the ride hardly moves it.
    """
    start = span.lower.copy()
    together = sorted(CLOSED.union(*(companions(world, other) for other in opened)))
    start[together] = span.upper[together]
    world.place(start)
    law = _law(world, index, span, config)
    track = _DriveTrack(world, start, index, span, config)
    turning_point = config.ramp_s + config.hold_s
    goal = start.copy()
    speed = np.zeros_like(start)
    acceleration = np.zeros_like(start)
    position = world.positions()
    velocity = world.velocities()
    balance = world.balance()
    track.weight_closed = track.opening(balance)
    for time in _times(config, world.time_step):
        goal[index], speed[index], acceleration[index] = _ramp(
            time, span.lower[index], span.travel[index], config
        )
        pull = law.pull(goal - position, speed, speed - velocity, acceleration)
        world.step(pull + balance)
        position = world.positions()
        velocity = world.velocities()
        if not track.see(position, velocity, pull):
            break
        balance = world.balance()
        if time >= turning_point and not track.turned and not track.turn(balance):
            break
    blocked_by = None if track.arrived or not track.finite else pressing(world, index)
    gain = let_go(world, config) if track.finite else Gain()
    return track.motion(world, opened, float(law.bound[index]), blocked_by, gain)


@dataclass(frozen=True)
class _Law:
    inertia: FloatArray
    stiffness: FloatArray
    drag: FloatArray
    damping: FloatArray
    friction: FloatArray
    lag: FloatArray
    bound: FloatArray

    def pull(
        self, error: FloatArray, speed: FloatArray, slip: FloatArray, acceleration: FloatArray
    ) -> FloatArray:
        """Return what the hand adds to the balance [N m] or [N], shape [joint_count].

        Args:
            error: how far each joint lags behind where it should be.
            speed: how fast it should be.
            slip: how much slower it is.
            acceleration: how fast it should gain speed.
        """
        pull = self.inertia * (acceleration + self.stiffness * error + self.drag * slip)
        pull += self.damping * speed + self.friction * np.tanh(error / self.lag)
        return np.minimum(np.maximum(pull, -self.bound), self.bound)


def _law(world: World, index: int, span: Ranges, config: MotionConfig) -> _Law:
    inertia = world.inertias()
    acceleration = 0.5 * span.size * (math.pi / config.ramp_s) ** 2
    frequency = np.full(len(inertia), config.hold_frequency)
    felt = {
        other: float(acceleration[index]) * _arm(world, other)
        for other, carried in enumerate(world.carried)
        if carried < world.carried[index] and span.size[other] > 0.0
    }
    for other, most in felt.items():
        size = float(span.size[other])
        stiff = math.sqrt(most / ((BUTTON_SHARE if size < BUTTON_M else RIDING_SHARE) * size))
        frequency[other] = max(frequency[other], min(stiff, RIDING_STEP / world.time_step))
    frequency[index] = config.drive_frequency
    damping = np.array([joint.damping or 0.0 for joint in world.joints])
    friction = np.array([joint.friction or 0.0 for joint in world.joints])
    swings = np.array([joint.kind != "prismatic" for joint in world.joints])
    arm = np.where(swings, np.sqrt(inertia / np.maximum(carried_masses(world), 1e-12)), 1.0)
    arm = np.minimum(arm, LONGEST_ARM_M)
    speed = 0.5 * math.pi * span.size / config.ramp_s
    bound = (
        config.hand_force_n * arm
        + config.inertia_margin * inertia * acceleration
        + damping * speed
        + friction
    )
    for other, most in felt.items():
        # Enough for the ride, so that what presses it still moves it.
        bound[other] = config.inertia_margin * inertia[other] * most + friction[other]
    # What must move along is not held back.
    bound[sorted(companions(world, index) - {index})] = 0.0
    return _Law(
        inertia,
        frequency**2,
        2.0 * frequency,
        damping,
        friction,
        FRICTION_LAG * span.size + 1e-6,
        bound,
    )


def _arm(world: World, other: int) -> float:
    """What a joint feels of an acceleration that it rides on: a slide the arm to its axis [m]."""
    return RIDING_ARM_M if world.joints[other].kind == "prismatic" else 1.0


def _times(config: MotionConfig, time_step: float) -> list[float]:
    total = 2.0 * (config.ramp_s + config.hold_s)
    return [i * time_step for i in range(1, round(total / time_step) + 1)]


def _ramp(
    time: float, lower: float, travel: float, config: MotionConfig
) -> tuple[float, float, float]:
    back = time - config.ramp_s - config.hold_s
    phase = min(time / config.ramp_s, 1.0) if back < 0.0 else 1.0 + min(back / config.ramp_s, 1.0)
    rate = math.pi / config.ramp_s if phase % 1.0 > 0.0 else 0.0
    position = lower + 0.5 * travel * (1.0 - math.cos(math.pi * phase))
    speed = 0.5 * travel * rate * math.sin(math.pi * phase)
    acceleration = 0.5 * travel * rate**2 * math.cos(math.pi * phase)
    return position, speed, acceleration


class _DriveTrack:
    """What was seen of one drive so far."""

    def __init__(
        self, world: World, start: FloatArray, index: int, span: Ranges, config: MotionConfig
    ) -> None:
        self._start = start
        self._index = index
        self._config = config
        self._lower = float(span.lower[index])
        self._travel = float(span.travel[index])
        self._sizes = span.size
        self._together = sorted(companions(world, index))
        # Shares of the way, counted from where the drive begins.
        self._highest = self._lowest = self._last = 0.0
        self._at = self._lower
        self._moved = np.zeros(len(start))
        self._fastest = self._force = self.weight_closed = 0.0
        self._weight_open: float | None = None
        self.turned = False
        self.finite = True

    @property
    def reached(self) -> float:
        """Return the highest share of the range."""
        return min(max(0.0, self._highest), 1.0)

    @property
    def returned(self) -> float:
        """Return the share of the range that is open now."""
        return min(max(0.0, self._last), 1.0)

    @property
    def arrived(self) -> bool:
        """Return whether it opened, and closed again."""
        return (
            self.reached >= self._config.reach_fraction
            and self.returned <= self._config.return_fraction
        )

    def opening(self, forces: FloatArray) -> float:
        """Return what opens the joint, of these forces [N m] or [N]."""
        force = float(forces[self._index])
        return force if self._travel > 0.0 else 0.0 - force

    def see(self, position: FloatArray, velocity: FloatArray, pull: FloatArray) -> bool:
        """Note one step; False if a number is none."""
        self.finite = bool(np.isfinite(position).all() and np.isfinite(velocity).all())
        if not self.finite:
            return False
        self._at = float(position[self._index])
        self._last = (self._at - self._lower) / self._travel
        self._highest = max(self._highest, self._last)
        self._lowest = min(self._lowest, self._last)
        self._moved = np.maximum(self._moved, np.abs(position - self._start))
        self._fastest = max(self._fastest, abs(float(velocity[self._index])))
        if not self.turned:
            self._force = max(self._force, self.opening(pull))
        return True

    def turn(self, balance: FloatArray) -> bool:
        """Note that the way back begins; False if there is none, since the joint did not open."""
        self.turned = True
        if self.reached < self._config.reach_fraction:
            return False
        self._weight_open = self.opening(balance)
        return True

    def motion(
        self,
        world: World,
        opened: Joints,
        bound: float,
        blocked_by: tuple[str, str] | None,
        gain: Gain,
    ) -> JointMotion:
        """Return all of it."""
        shares = np.array([share(m, s) for m, s in zip(self._moved, self._sizes, strict=True)])
        shares[self._together] = 0.0
        most = int(np.argmax(shares))
        return JointMotion(
            joint=world.joints[self._index].name,
            reached=self.reached,
            returned=self.returned,
            overshoot=max(0.0, self._highest - 1.0, -self._lowest) * abs(self._travel),
            others_moved=float(shares[most]),
            peak_speed=self._fastest,
            finite=self.finite and gain.finite,
            range=abs(self._travel),
            needs_open=tuple(world.joints[other].name for other in sorted(opened)),
            pushed=world.joints[most].name if shares[most] > 0.0 else None,
            blocked_by=blocked_by,
            stuck_at=None if self.arrived else self._at,
            opening_force=self._force,
            force_bound=bound,
            weight_closed=self.weight_closed,
            weight_open=self._weight_open,
            energy=gain.energy,
            energy_height=gain.height,
        )
