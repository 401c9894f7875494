"""The object left alone: weightless, only contact moves it; with gravity, it falls as it may."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from ..config import MotionConfig
from ..description import FloatArray
from ..geometry.statics import GRAVITY
from .simulator import Fall, FallMotion, RestMotion
from .world import World

#: A joint without a range stands still below this [rad/s] or [m/s].
STILL = 1e-6
#: Of a short wait, all must stand still for this share before it ends.
STILL_SHARE = 0.4


@dataclass(frozen=True)
class Gain:
    """Kinetic energy that one joint gained [J], and the height that it would lift its load [m]."""

    energy: float = 0.0
    height: float = 0.0
    finite: bool = True


def rest(world: World, config: MotionConfig) -> tuple[RestMotion, ...]:
    """Leave every joint alone at lower, weightless and without springs: only contact moves it.

    Without gravity and springs no force has anything to give but contact, so all kinetic energy is
    contact's. Balancing forces would say the same less exactly: they do work of their own as soon
    as something moves.
    """
    free = world.uncoupled
    if not free:
        return ()
    span = world.span
    world.place(span.lower)
    world.weigh(False)
    drift = np.zeros(len(world.joints))
    kinetic = _Kinetic(world, config)
    mass = world.carried_masses
    pushed_by: dict[int, tuple[str, str] | None] = {}
    for position, velocity in left_alone(world, config.rest_s, config):
        pushed_by = pushed_by or {i: world.pressing(i) for i in free}
        drift = np.maximum(drift, np.abs(position - span.lower))
        kinetic.see(velocity)
    finite = world.is_finite()
    world.weigh(True)
    energy = kinetic.gained
    return tuple(
        RestMotion(
            world.joints[i].name,
            float(drift[i]),
            share(drift[i], span.size[i]),
            finite,
            float(energy[i]),
            height(energy[i], mass[i]),
            pushed_by.get(i),
        )
        for i in free
    )


def fall(world: World, config: MotionConfig) -> Fall:
    """Leave every joint alone at lower with gravity and springs: what opens by weight, how far.

    Kinetic and potential energy together can only be lost here; what they gain, the engine made up.
    """
    free = world.uncoupled
    if not free:
        return Fall()
    span = world.span
    world.place(span.lower)
    limited = np.array([np.isfinite(joint.lower) for joint in world.joints])
    moved = np.zeros(len(world.joints))
    before = most = world.energy()
    slow = _slow(world, config)
    for position, velocity in left_alone(world, config.rest_s, config):
        # A soft limit that gives way under the weight opens nothing.
        into = position - span.lower
        moved = np.maximum(moved, np.where(limited, into, np.abs(into)))
        if (np.abs(velocity) > slow).any():
            most = max(most, world.energy())
    rows = ((world.joints[i].name, float(moved[i]), share(moved[i], span.size[i])) for i in free)
    joints = tuple(FallMotion(*row) for row in rows)
    # What pulls coupled joints to where they belong together gives energy, too.
    gained = most - before if len(free) == len(world.joints) else 0.0
    return Fall(joints, world.is_finite(), float(gained), height(gained, world.moving_mass))


def let_go(world: World, config: MotionConfig) -> Gain:
    """Let go of the joints where they are, weightless: the energy that any joint gains then."""
    free = world.uncoupled
    if not free:
        return Gain()
    world.weigh(False)
    kinetic = _Kinetic(world, config)
    mass = world.carried_masses
    for _, velocity in left_alone(world, config.release_s, config):
        kinetic.see(velocity)
    finite = world.is_finite()
    world.weigh(True)
    energies = ((float(kinetic.gained[i]), height(kinetic.gained[i], mass[i])) for i in free)
    return max((Gain(*each, finite) for each in energies), key=lambda gain: gain.height)


class _Kinetic:
    """Kinetic energy each joint gained by contact alone since now [J], shape [joint_count].

    A joint's own is what it would have, were it alone to move. Linked bodies hand energy to and
    fro, so a joint can gain of its own what another lost; but all joints together cannot, and no
    joint is charged with more than that.
    """

    def __init__(self, world: World, config: MotionConfig) -> None:
        self._world = world
        self._inertia = np.diag(world.mass_matrix())
        self._slow = _slow(world, config)
        self._own = self._inertia * world.velocities() ** 2 / 2.0
        self._all = world.energy()
        self.gained = np.zeros(len(world.joints))

    def see(self, velocity: FloatArray) -> None:
        """Note one step."""
        if (np.abs(velocity) > self._slow).any():
            together = self._world.energy() - self._all
            own = self._inertia * velocity**2 / 2.0 - self._own
            self.gained = np.maximum(self.gained, np.minimum(own, together))


def left_alone(
    world: World,
    seconds: float,
    config: MotionConfig,
    forces: Callable[[], FloatArray] | None = None,
) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Yield the positions and velocities step by step, until time is up or all are at rest.

    It ends as well, and yields no more, where one of them is no number.

    Applied are ``forces`` where given, asked before every step, else none.

    Forces in these engines depend on where things are and how they move, and nothing is put to
    sleep. So a link that stands still for half a second, or most of a shorter wait, goes on doing
    so, but for two: a constant push too weak to show yet, and a fall from the very top
    of a hill. Below the speed that counts as still, such a push cannot reach a reported drift in
    the time that is left; a fall, like any push, shows as a speed that grows, and then the wait
    goes on.
    """
    nothing = np.zeros(len(world.joints))
    slow = _slow(world, config)
    window = max(2, round(min(config.still_s, STILL_SHARE * seconds) / world.time_step))
    # Of joints that the drive does not know nobody can say whether they stand still.
    known = len(world.model.joints) == len(world.joints)
    speeds: list[float] = []
    for _ in range(round(seconds / world.time_step)):
        world.step(nothing if forces is None else forces())
        position = world.positions()
        velocity = world.velocities()
        if not (np.isfinite(position).all() and np.isfinite(velocity).all()):
            return
        yield position, velocity
        speeds.append(float((np.abs(velocity) / slow).max()))
        if known and len(speeds) >= window and speeds[-1] <= 1.0:
            early = speeds[-window : -window // 2]
            late = speeds[-window // 2 :]
            if max(late) <= max(early) <= 1.0:
                return


def _slow(world: World, config: MotionConfig) -> FloatArray:
    return np.maximum(config.still_share * world.span.size, STILL)


def share(moved: float, size: float) -> float:
    """Return a share of the range; 0 for a joint without one."""
    return float(moved / size) if size > 0.0 else 0.0


def height(energy: float, mass: float) -> float:
    """Return how high the energy [J] would lift the mass [kg], in metres; 0 for no mass."""
    return float(energy / (mass * GRAVITY)) if mass > 0.0 else 0.0
