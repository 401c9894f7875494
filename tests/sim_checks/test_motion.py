"""The drive is the same in every engine; here it moves a world whose mechanics are known in closed form."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from asset_factory.sim_checks.checks.motion import check_motion
from asset_factory.sim_checks.config import CheckConfig, MotionConfig
from asset_factory.sim_checks.description import Description, FloatArray
from asset_factory.sim_checks.simulators.drive import rest, sweep
from asset_factory.sim_checks.simulators.simulator import (
    JointMotion,
    LoadedJoint,
    LoadedModel,
    Observation,
    RestMotion,
    World,
)

CONFIG = MotionConfig()


class Sliders:
    """Blocks on rails: mass [kg], weight along the rail [N], friction [N], and a wall or spring at will."""

    time_step = CONFIG.time_step_s

    def __init__(self, masses: list[float], upper: float = 0.3, weight: float = 0.0, friction: float = 0.0) -> None:
        self.joints = tuple(LoadedJoint(f"j{i}", "prismatic", 0.0, upper, 0.0, friction) for i in range(len(masses)))
        self.model = LoadedModel((), self.joints, ())
        self._mass, self._weight, self._friction = np.array(masses), weight, friction
        self._q, self._v = np.zeros(len(masses)), np.zeros(len(masses))
        self.wall = np.inf
        self.gate = False
        self.push = 0.0
        self.strongest = 0.0

    def place(self, positions: FloatArray) -> None:
        self._q, self._v = positions.copy(), np.zeros_like(positions)

    def positions(self) -> FloatArray:
        return self._q.copy()

    def velocities(self) -> FloatArray:
        return self._v.copy()

    def inertias(self) -> FloatArray:
        return self._mass

    def carried_masses(self) -> FloatArray:
        return self._mass

    def balance(self) -> FloatArray:
        return np.full(len(self._mass), self._weight)

    def step(self, forces: FloatArray) -> None:
        self.strongest = max(self.strongest, float(np.abs(forces - self._weight).max()))
        net = forces - self._weight + self.push
        free = self._v + self.time_step * net / self._mass
        brake = self.time_step * self._friction / self._mass
        self._v = np.sign(free) * np.maximum(np.abs(free) - brake, 0.0)
        self._q = np.clip(self._q + self.time_step * self._v, 0.0, [joint.upper for joint in self.joints])
        wall = 0.05 if self.gate and self._q[-1] < 0.1 else self.wall
        if self._q[0] > wall:
            self._q[0], self._v[0] = wall, 0.0

    def link_poses(self) -> dict[str, FloatArray]:
        return {}

    def warnings(self) -> tuple[str, ...]:
        return ()


def only(world: World) -> JointMotion:
    (motion,) = sweep(world, CONFIG)
    return motion


@pytest.mark.parametrize("mass", [0.001, 0.1, 5.0, 80.0])
@pytest.mark.parametrize("weight", [0.0, 1.0])
def test_a_free_slider_of_any_mass_goes_all_the_way_and_back(mass: float, weight: float) -> None:
    motion = only(Sliders([mass], weight=weight * 9.81 * mass))
    assert motion.reached > 0.999
    assert motion.returned < 0.001
    # The ramp is half a cosine: its steepest slope is pi/2 times the mean speed.
    assert motion.peak_speed == pytest.approx(0.5 * np.pi * 0.3 / CONFIG.ramp_s, rel=0.01)


@pytest.mark.parametrize("friction", [0.5, 5.0, 50.0])
def test_the_file_s_own_friction_never_jams(friction: float) -> None:
    motion = only(Sliders([2.0], friction=friction))
    assert motion.reached > 0.98
    assert motion.returned < 0.02


def test_a_wall_is_reached_and_not_passed() -> None:
    world = Sliders([2.0])
    world.wall = 0.12
    assert only(world).reached == pytest.approx(0.4, abs=1e-6)


def test_the_hand_never_pulls_harder_than_its_bound() -> None:
    world = Sliders([2.0])
    world.wall = 0.12
    only(world)
    acceleration = 0.5 * 0.3 * (np.pi / CONFIG.ramp_s) ** 2
    assert world.strongest <= CONFIG.hand_force_n + CONFIG.inertia_margin * 2.0 * acceleration + 1e-9


def test_a_slider_behind_another_opens_once_the_other_is_open() -> None:
    world = Sliders([2.0, 2.0])
    world.gate = True
    first, second = sweep(world, CONFIG)
    assert (first.others_at, second.others_at) == ("upper", "lower")
    assert first.reached > 0.999


def test_of_joints_that_move_together_one_that_opens_speaks_for_all() -> None:
    class Coupled(Sliders):
        def step(self, forces: FloatArray) -> None:
            super().step(np.full(2, forces[1]))

    world = Coupled([2.0, 2.0])
    world.joints = (world.joints[0], replace(world.joints[1], follows="j0"))
    motion = only(world)
    assert (motion.joint, motion.reached > 0.99, motion.others_moved) == ("j1", True, 0.0)
    assert rest(world, CONFIG) == ()


def test_what_only_contact_moves_is_seen_at_rest() -> None:
    calm = Sliders([2.0], weight=20.0)
    assert rest(calm, CONFIG)[0].drift == 0.0
    pushed = Sliders([2.0])
    pushed.push = 1.0
    # 0.5 a t^2
    assert rest(pushed, CONFIG)[0].drift == pytest.approx(0.25 * CONFIG.rest_s**2, rel=0.02)


GOOD = JointMotion("j", 1.0, 0.0, 0.0, 0.0, 1.0, finite=True, range=0.3, pushed="k")


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({}, []),
        ({"reached": 0.5}, [("jammed", "hard", 0.5)]),
        ({"returned": 0.2}, [("not_returned", "hard", 0.2)]),
        ({"overshoot": 0.009}, [("limit_overshoot", "soft", 0.03)]),
        ({"overshoot": 0.09}, [("limit_overshoot", "hard", 0.3)]),
        ({"others_moved": 0.06}, [("others_moved", "soft", 0.06)]),
        ({"others_moved": 0.6}, [("others_moved", "hard", 0.6)]),
        ({"finite": False}, [("not_finite", "hard", None)]),
    ],
)
def test_each_fault_of_a_motion_is_named_with_its_number(
    changes: dict[str, float], expected: list[tuple[str, str, float | None]]
) -> None:
    observation = Observation(LoadedModel((), (), ()), motions=(replace(GOOD, **changes),))  # type: ignore[arg-type]
    findings = check_motion(nothing(), "engine", observation, CheckConfig()).findings
    assert [(f.code, str(f.severity), f.value) for f in findings] == expected


@pytest.mark.parametrize(("share", "expected"), [(0.01, []), (0.05, ["soft"]), (0.5, ["hard"])])
def test_parts_that_push_each_other_at_rest_are_named(share: float, expected: list[str]) -> None:
    observation = Observation(LoadedModel((), (), ()), rest=(RestMotion("j", 0.3 * share, share, finite=True),))
    findings = check_motion(nothing(), "engine", observation, CheckConfig()).findings
    assert [str(f.severity) for f in findings if f.code == "pushed_at_rest"] == expected


def nothing() -> Description:
    from pathlib import Path

    return Description(Path("nothing.urdf"), "urdf", (), ())
