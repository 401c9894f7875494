"""The drive from closed to open and back: one control law and force bound for every engine."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence

import numpy as np

from ..config import MotionConfig
from ..description import FloatArray
from .law import drive_law
from .rest import Gain, let_go, share
from .simulator import JointMotion
from .world import Groups, World

#: How often the joints that make way are added to, because another link stands behind them.
WIDENED = 3

Joints = frozenset[int]
CLOSED: Joints = frozenset()


def sweep(world: World, config: MotionConfig, apart: Groups = ()) -> tuple[JointMotion, ...]:
    """Drive every joint, others held lightly at lower; if it fails, again with some opened.

    The joints of a group in ``apart``, by name, cannot reach one another: they are driven at the
    same time, and those alone of which there is more to say than that they open and close.

    Only joints that have opened themselves in this world make way, together with those that they
    needed for it: two joints that bar each other never open. Of joints that are forced to move
    together, one that opens speaks for all: the others may have no way to push it.
    """
    order = _Order(world, config, apart)
    order.settle()
    motions = order.motions.items()
    opened = {index for index, motion in motions if arrived(motion, config)}
    return tuple(m for i, m in motions if i in opened or not opened & world.companions(i))


class _Order:
    """Which joints open, and which others must be open for it."""

    def __init__(self, world: World, config: MotionConfig, apart: Groups) -> None:
        self._world = world
        self._config = config
        driven = np.flatnonzero(world.span.size > 0.0).tolist()
        self._driven: dict[tuple[int, Joints], JointMotion] = {}
        for names in apart:
            self._drive_together([i for i in driven if world.joints[i].name in names])
        self.motions = {index: self._drive(index, CLOSED) for index in driven}
        opening = (index for index, motion in self.motions.items() if opens(motion, config))
        self.needs = dict.fromkeys(opening, CLOSED)

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

    def _drive_together(self, indices: list[int]) -> None:
        """Drive joints that cannot reach one another; forget those that did more than that."""
        together = [i for i in indices if len(self._world.companions(i)) == 1]
        if len(together) < 2:
            return
        motions = drive(self._world, together, CLOSED, self._config)
        for i, motion in zip(together, motions, strict=True):
            if is_plain(motion, self._config):
                self._driven[i, CLOSED] = motion

    def _drive(self, index: int, opened: Joints) -> JointMotion:
        """Drive a joint with others open, once."""
        if (index, opened) not in self._driven:
            (motion,) = drive(self._world, [index], opened, self._config)
            self._driven[index, opened] = motion
        return self._driven[index, opened]

    def _makers(self, index: int) -> Iterator[Joints]:
        """Yield the joints that move one of two links in contact, or were pushed.

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
            return frozenset(i for i in range(len(world.joints)) if self._leans(motion, i))
        one, two = motion.blocked_by
        carried = enumerate(world.carried)
        return frozenset(i for i, links in carried if (one in links) != (two in links))

    def _all(self, index: int) -> Iterator[Joints]:
        """Yield all needed joints at once: the hardest contact need not be the obstacle."""
        yield self._ready(index)

    def _ready(self, index: int) -> Joints:
        return frozenset(self.needs) - self._world.companions(index)


def arrived(motion: JointMotion, config: MotionConfig) -> bool:
    """Return whether the joint went all the way there and back."""
    there = motion.reached >= config.reach_fraction
    return motion.finite and there and motion.returned <= config.return_fraction


def opens(motion: JointMotion, config: MotionConfig) -> bool:
    """Return whether it did without pushing another open: that other has to open first."""
    return arrived(motion, config) and motion.others_moved <= config.others_hard


def is_plain(motion: JointMotion, config: MotionConfig) -> bool:
    """Return whether it opened and closed, pushed nothing, kept its limits and gained no energy."""
    return (
        arrived(motion, config)
        and motion.others_moved <= config.others_soft
        and motion.overshoot <= config.overshoot_soft * motion.range
        and motion.energy <= config.energy_floor_j
    )


def drive(
    world: World, indices: Sequence[int], opened: Joints, config: MotionConfig
) -> tuple[JointMotion, ...]:
    """Drive joints at the same time from lower to upper and back by a bounded force, then let go.

    They follow a smooth ramp. The force is a mass-scaled pull towards the ramp, clipped to a hand's
    strength, on top of what balances gravity and the file's own damping and friction. The other
    joints are held the same way, but softly: those in ``opened`` at upper, the rest at lower. What
    rides on the part that is driven, a button on a door, is held so that the ride hardly moves it.
    """
    span = world.span
    start = world.standing_open(opened)
    world.place(start)
    mass = world.mass_matrix()
    law = drive_law(world, mass, indices, config)
    linked = world.carries_joints
    tracks = [_DriveTrack(world, start, indices, index, config) for index in indices]
    turning_point = config.ramp_s + config.hold_s
    goal = start.copy()
    speed = np.zeros_like(start)
    acceleration = np.zeros_like(start)
    position = world.positions()
    velocity = world.velocities()
    balance = world.balance()
    for track in tracks:
        track.weight_closed = track.opening(balance)
    turned = False
    for step in range(1, round(2.0 * turning_point / world.time_step) + 1):
        time = step * world.time_step
        ramp = _ramp(time, span.lower[indices], span.travel[indices], config)
        goal[indices], speed[indices], acceleration[indices] = ramp
        pull = law.pull(mass, goal - position, speed, speed - velocity, acceleration)
        world.step(pull + balance)
        position = world.positions()
        velocity = world.velocities()
        finite = [track.see(position, velocity, pull) for track in tracks]
        if not all(finite):
            break
        balance = world.balance()
        if linked:
            mass = world.mass_matrix()
        if time >= turning_point and not turned:
            turned = True
            opened_up = [track.turn(balance) for track in tracks]
            if not any(opened_up):
                break
    by_index = dict(zip(indices, tracks, strict=True))
    stuck = (i for i, track in by_index.items() if track.finite and not track.arrived)
    stopped = {i: world.pressing(i) for i in stuck}
    gain = let_go(world, config) if all(track.finite for track in tracks) else Gain()
    ends = ((track, float(law.bound[i]), stopped.get(i)) for i, track in by_index.items())
    return tuple(track.motion(opened, bound, held, gain) for track, bound, held in ends)


def _ramp(
    time: float, lower: FloatArray, travel: FloatArray, config: MotionConfig
) -> tuple[FloatArray, FloatArray, FloatArray]:
    back = time - config.ramp_s - config.hold_s
    phase = min(time / config.ramp_s, 1.0) if back < 0.0 else 1.0 + min(back / config.ramp_s, 1.0)
    rate = math.pi / config.ramp_s if phase % 1.0 > 0.0 else 0.0
    position = lower + 0.5 * travel * (1.0 - math.cos(math.pi * phase))
    speed = 0.5 * travel * rate * math.sin(math.pi * phase)
    acceleration = 0.5 * travel * rate**2 * math.cos(math.pi * phase)
    return position, speed, acceleration


class _DriveTrack:
    """The observations of one drive so far."""

    def __init__(
        self,
        world: World,
        start: FloatArray,
        indices: Sequence[int],
        index: int,
        config: MotionConfig,
    ) -> None:
        self._world = world
        self._start = start
        self._index = index
        self._config = config
        self._lower = float(world.span.lower[index])
        self._travel = float(world.span.travel[index])
        self._together = sorted(world.companions(index).union(indices))
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
        there = self.reached >= self._config.reach_fraction
        return there and self.returned <= self._config.return_fraction

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
        self, opened: Joints, bound: float, blocked_by: tuple[str, str] | None, gain: Gain
    ) -> JointMotion:
        """Return all of it."""
        shares = np.array([*map(share, self._moved, self._world.span.size)])
        shares[self._together] = 0.0
        most = int(np.argmax(shares))
        names = [joint.name for joint in self._world.joints]
        return JointMotion(
            joint=names[self._index],
            reached=self.reached,
            returned=self.returned,
            overshoot=max(0.0, self._highest - 1.0, -self._lowest) * abs(self._travel),
            others_moved=float(shares[most]),
            peak_speed=self._fastest,
            finite=self.finite and gain.finite,
            range=abs(self._travel),
            needs_open=tuple(names[other] for other in sorted(opened)),
            pushed=names[most] if shares[most] > 0.0 else None,
            blocked_by=blocked_by,
            stuck_at=None if self.arrived else self._at,
            opening_force=self._force,
            force_bound=bound,
            weight_closed=self.weight_closed,
            weight_open=self._weight_open,
            energy=gain.energy,
            energy_height=gain.height,
        )
