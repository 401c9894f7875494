"""What rest, fall and drive ask of a world's joints: their ends, who moves with whom, and what each one carries."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..description import FloatArray
from .simulator import World

#: A joint without limits is swept through one turn; its sliding cousin has no sweep of its own.
FULL_TURN = 2.0 * math.pi
GRAVITY = 9.81


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


def companions(world: World, index: int) -> frozenset[int]:
    """The joint and all that are forced to move with it."""
    pairs = [{joint.name, joint.follows} for joint in world.joints if joint.follows is not None]
    found: set[str | None] = {world.joints[index].name}
    for _ in pairs:
        found |= {name for pair in pairs if pair & found for name in pair}
    return frozenset(i for i, joint in enumerate(world.joints) if joint.name in found)


def uncoupled(world: World) -> list[int]:
    """Joints that no other is forced to move with; of the others, not all may be able to be at lower together."""
    return [i for i in range(len(world.joints)) if len(companions(world, i)) == 1]


def carried_masses(world: World) -> FloatArray:
    """Mass that each joint moves [kg], shape [joint_count]."""
    return np.array([_mass(world, names) for names in world.carried], np.float64)


def moving_mass(world: World) -> float:
    """Mass of all that any joint moves [kg]."""
    return _mass(world, frozenset[str]().union(*world.carried))


def share(moved: float, size: float) -> float:
    """Of the range; 0 for a joint without one."""
    return float(moved / size) if size > 0.0 else 0.0


def height(energy: float, mass: float) -> float:
    """How high the energy [J] would lift the mass [kg], in metres; 0 for no mass."""
    return float(energy / (mass * GRAVITY)) if mass > 0.0 else 0.0


def _mass(world: World, names: frozenset[str]) -> float:
    return float(sum(link.mass for link in world.model.links if link.name in names))
