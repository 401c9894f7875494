"""Blocks that slide and push one another, moved by formulas: a world in which all is known."""

import numpy as np

from asset_factory.sim_checks.config import MotionConfig
from asset_factory.sim_checks.description import FloatArray
from asset_factory.sim_checks.simulators.world import (
    LoadedJoint,
    LoadedLink,
    LoadedModel,
    Touch,
    World,
)

CONFIG = MotionConfig()


class Sliders(World):
    """Blocks on rails of 0.3 m: mass [kg], closing weight, friction, a wall or a push, all [N]."""

    time_step = CONFIG.time_step_s

    def __init__(self, masses: list[float], weight: float = 0.0, friction: float = 0.0) -> None:
        self.joints = tuple(
            LoadedJoint(f"j{i}", "prismatic", 0.0, 0.3, 0.0, friction) for i in range(len(masses))
        )
        links = tuple(LoadedLink(f"block{i}", mass, 1, None) for i, mass in enumerate(masses))
        post = LoadedLink("post", 0.0, 1, None, static=True)
        self.model = LoadedModel((*links, post), self.joints)
        self.carried = tuple(frozenset({link.name}) for link in links)
        self.steps = 0
        self._heavy = True
        self._pressed = 0.0
        self._mass = np.array(masses)
        self._weight = weight
        self._friction = friction
        self._q = np.zeros(len(masses))
        self._v = np.zeros(len(masses))
        self.wall = np.inf
        self.gate = False
        self.push = 0.0
        self.strongest = 0.0

    def place(self, positions: FloatArray) -> None:
        self._q = positions.copy()
        self._v = np.zeros_like(positions)

    def positions(self) -> FloatArray:
        return self._q.copy()

    def velocities(self) -> FloatArray:
        return self._v.copy()

    def mass_matrix(self) -> FloatArray:
        return np.diag(self._mass)

    def weigh(self, on: bool) -> None:
        self._heavy = on

    def energy(self) -> float:
        potential = self._weight * self._q.sum() if self._heavy else 0.0
        return float(0.5 * (self._mass * self._v**2).sum() + potential)

    def balance(self) -> FloatArray:
        return np.full(len(self._mass), self._weight)

    def contacts(self) -> dict[tuple[str, str], Touch]:
        return {("block0", "post"): Touch(self._pressed, 0.0)}

    def step(self, forces: FloatArray) -> None:
        self.steps += 1
        self._pressed = 0.0
        weight = self._weight if self._heavy else 0.0
        self.strongest = max(self.strongest, float(np.abs(forces - weight).max()))
        net = forces - weight + self.push
        free = self._v + self.time_step * net / self._mass
        brake = self.time_step * self._friction / self._mass
        self._v = np.sign(free) * np.maximum(np.abs(free) - brake, 0.0)
        ahead = self._q + self.time_step * self._v
        self._q = np.clip(ahead, 0.0, [joint.upper for joint in self.joints])
        self._v[self._q != ahead] = 0.0
        wall = 0.05 if self.gate and self._q[-1] < 0.1 else self.wall
        if self._q[0] > wall:
            self._q[0] = wall
            self._v[0] = 0.0
            self._pressed = float(net[0])
