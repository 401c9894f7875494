"""What rest, fall and drive ask of a world's joints: ends, couplings, contacts, and masses."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ..description import FloatArray
from ..geometry.coupling import Limits, common_range, led_by, sound_chains
from ..geometry.statics import GRAVITY
from .simulator import LoadedJoint, World

#: A joint without limits is swept through one turn; its sliding cousin has no sweep of its own.
FULL_TURN = 2.0 * math.pi

#: Names of joints that cannot reach one another, by group.
Groups = tuple[tuple[str, ...], ...]


@dataclass(frozen=True)
class Ranges:
    """Where each joint is driven from and to [rad] or [m], shape [joint_count] each.

    One that follows another is where that one takes it, so its ``upper`` may lie below its
    ``lower``.
    """

    lower: FloatArray
    upper: FloatArray

    @property
    def travel(self) -> FloatArray:
        """Return the upper minus lower; negative for a joint that another takes backwards."""
        return self.upper - self.lower

    @property
    def size(self) -> FloatArray:
        """Return the same without its sign; 0 for a joint that is not driven."""
        return np.abs(self.travel)


def ranges(world: World) -> Ranges:
    """Return the drive's ends: the limits, or 0 to a full turn, or 0 to 0.

    A full turn is for joints without limits, 0 to 0 for those with nothing sensible. A leader goes
    as far as all that follow it can, and they go along. Put at their own lower limits instead, two
    doors of which one follows the other backwards would begin with one of them open.
    """
    ends = {joint.name: _ends(joint) for joint in world.joints}
    limited = [joint for joint in world.joints if joint.lower < joint.upper]
    limits = {joint.name: (joint.lower, joint.upper) for joint in limited}
    sound = sound_chains({joint.name: joint.mimic for joint in world.joints})
    for leader, wholes in led_by(sound).items():
        lower, upper = ends[leader]
        followers = ((whole, limits.get(name)) for name, whole in wholes.items())
        ends[leader] = common_range((lower, upper), followers) or (lower, lower)
        for name, whole in wholes.items():
            lower, upper = (whole.multiplier * end + whole.offset for end in ends[leader])
            ends[name] = lower, upper
    both = np.array([ends[joint.name] for joint in world.joints], np.float64).reshape(-1, 2)
    return Ranges(both[:, 0], both[:, 1])


def _ends(joint: LoadedJoint) -> Limits:
    lower = joint.lower
    upper = joint.upper
    if not (math.isfinite(lower) and math.isfinite(upper)):
        return 0.0, FULL_TURN if joint.kind in ("revolute", "continuous") else 0.0
    return lower, max(lower, upper)


def companions(world: World, index: int) -> frozenset[int]:
    """Return the joint and all that are forced to move with it."""
    pairs = [{joint.name, joint.follows} for joint in world.joints if joint.follows is not None]
    found: set[str | None] = {world.joints[index].name}
    for _ in pairs:
        found |= {name for pair in pairs if pair & found for name in pair}
    return frozenset(i for i, joint in enumerate(world.joints) if joint.name in found)


def standing_open(world: World, opened: Iterable[int], span: Ranges) -> FloatArray:
    """Return joints at upper, with all that move with them, and the others at lower."""
    values = span.lower.copy()
    together = sorted(frozenset[int]().union(*(companions(world, index) for index in opened)))
    values[together] = span.upper[together]
    return values


def pressing(world: World, index: int) -> tuple[str, str] | None:
    """Return the links that pressed hardest in the last step, one of them moved by a joint.

    Names come in the order of the model's links; ``None`` if nothing presses across the joint.
    """
    moved = world.carried[index]
    presses = ((pair, touch) for pair, touch in world.contacts().items() if touch.presses)
    across = ((p, touch) for p, touch in presses if (p[0] in moved) != (p[1] in moved))
    return max(((t.force, t.depth, p) for p, t in across), default=(0.0, 0.0, None))[2]


def any_carried(world: World) -> bool:
    """Return whether a joint moves another one, so that the mass matrix changes as it does."""
    each = sum(len(links) for links in world.carried)
    return each > len(frozenset[str]().union(*world.carried))


def uncoupled(world: World) -> list[int]:
    """Return joints that no other is forced to move with; the rest may move without contact."""
    return [i for i in range(len(world.joints)) if len(companions(world, i)) == 1]


def carried_masses(world: World) -> FloatArray:
    """Return the mass that each joint moves [kg], shape [joint_count]."""
    return np.array([_mass(world, names) for names in world.carried], np.float64)


def moving_mass(world: World) -> float:
    """Return the mass of all that any joint moves [kg]."""
    return _mass(world, frozenset[str]().union(*world.carried))


def finite(world: World) -> bool:
    """Return whether all is still a number: where joints are, and how they move."""
    return bool(np.isfinite(world.positions()).all() and np.isfinite(world.velocities()).all())


def share(moved: float, size: float) -> float:
    """Return a share of the range; 0 for a joint without one."""
    return float(moved / size) if size > 0.0 else 0.0


def height(energy: float, mass: float) -> float:
    """Return how high the energy [J] would lift the mass [kg], in metres; 0 for no mass."""
    return float(energy / (mass * GRAVITY)) if mass > 0.0 else 0.0


def _mass(world: World, names: frozenset[str]) -> float:
    return float(sum(link.mass for link in world.model.links if link.name in names))
