"""Joints that friction should hold, in worlds whose motion is known, and in MuJoCo and PyBullet."""

from dataclasses import replace

import numpy as np
import pytest
from box_world import body, described, joint
from fault_corpus.exhibits import edited, mjcf, restated, urdf
from fault_corpus.good_things import button
from sliders import CONFIG, Sliders

from asset_factory.sim_checks.checks.creep import check_creep
from asset_factory.sim_checks.config import CheckConfig
from asset_factory.sim_checks.read.read import read_description
from asset_factory.sim_checks.simulators.catalog import installed
from asset_factory.sim_checks.simulators.drive import sweep
from asset_factory.sim_checks.simulators.hold import hold
from asset_factory.sim_checks.simulators.observe import observe
from asset_factory.sim_checks.simulators.simulator import HoldMotion, JointMotion, Observation

#: Of the button and its friction: what it weighs, and what holds it [N].
WEIGHT = 0.02 * 9.81
PRESS = ".//joint[@name='press']"


class Creeping(Sliders):
    """Blocks that friction does not stop below a speed [m/s]."""

    speed = 0.0

    def step(self, forces):
        super().step(forces)
        self._q = np.clip(self._q + self.time_step * self.speed, 0.0, 0.3)

    def velocities(self):
        return super().velocities() + self.speed


def creeping(speed, **world):
    blocks = Creeping([2.0], **world)
    motions = sweep(blocks, CONFIG)
    blocks.speed = speed
    return hold(blocks, motions, CONFIG)


def slide(friction, mass_axis=(0.0, 0.0, 1.0)):
    """A block of 2 kg that slides by 0.3 m along an axis."""
    links = [
        body("post", [((0.0, 0.0, 0.0), (0.1, 0.1, 0.1))]),
        body("block0", [((0.0, 0.0, 0.5), (0.1, 0.1, 0.1))]),
    ]
    line = joint("j0", "prismatic", "post", "block0", (0.0, 0.0, 0.0), mass_axis, (0.0, 0.3))
    return described(links, [replace(line, friction=friction)])


def told(description, *holds, soft=False):
    motions = (JointMotion("j0", 1.0, 0.0, 0.0, 0.0, 1.0, finite=True, range=0.3),)
    observation = Observation(None, motions=motions, holds=holds)
    return list(check_creep(description, "engine", observation, CheckConfig(), soft=soft).findings)


def test_a_held_block_is_left_alone_at_three_values_and_stays():
    holds = creeping(0.0, weight=19.62, friction=25.0)
    assert [item.values["j0"] for item in holds] == pytest.approx([0.075, 0.15, 0.225])
    assert [item.moved for item in holds] == [0.0, 0.0, 0.0]


def test_a_creeping_block_is_watched_to_the_end():
    holds = creeping(0.01, weight=19.62, friction=25.0)
    assert [item.moved for item in holds] == pytest.approx([0.02] * 3)


@pytest.mark.parametrize(
    ("weight", "friction"), [(19.62, 20.0), (-19.62, 20.0), (0.0, 0.0)], ids=["down", "up", "none"]
)
def test_only_friction_that_outweighs_a_block_is_asked_to_hold_it(weight, friction):
    assert creeping(0.01, weight=weight, friction=friction) == ()


def test_a_joint_that_does_not_open_is_not_left_alone_on_its_way():
    blocks = Sliders([2.0], friction=5.0)
    blocks.wall = 0.1
    assert hold(blocks, sweep(blocks, CONFIG), CONFIG) == ()


def test_other_joints_are_balanced_and_those_in_the_way_open():
    blocks = Sliders([2.0, 2.0], weight=19.62, friction=25.0)
    blocks.gate = True
    holds = hold(blocks, sweep(blocks, CONFIG), CONFIG)
    assert [item.moved for item in holds] == [0.0] * 6
    assert {item.values["j1"] for item in holds if item.joint == "j0"} == {0.3}
    assert {item.values["j0"] for item in holds if item.joint == "j1"} == {0.0}


def test_blocks_that_cannot_meet_are_left_alone_at_the_same_time():
    together, one_by_one = (Sliders([2.0, 3.0], weight=19.62, friction=25.0) for _ in range(2))
    motions = sweep(one_by_one, CONFIG)
    before = one_by_one.steps
    held = hold(one_by_one, motions, CONFIG)
    at_once = hold(together, motions, CONFIG, (("j0", "j1"),))
    assert [(one.joint, one.moved) for one in at_once] == [(one.joint, one.moved) for one in held]
    assert 2 * together.steps == one_by_one.steps - before


@pytest.mark.parametrize(
    ("moved", "codes"), [(0.0009, []), (0.0011, ["creeps"]), (0.1, ["creeps"])]
)
def test_a_millimetre_is_what_a_long_slide_may_creep(moved, codes):
    found = told(slide(25.0), HoldMotion("j0", {"j0": 0.15}, moved))
    assert [item.code for item in found] == codes
    assert all((item.value, item.unit, item.limit) == (moved, "m", 0.001) for item in found)


def test_of_three_values_the_worst_is_told_once():
    holds = (HoldMotion("j0", {"j0": at}, 0.01 + at) for at in (0.075, 0.225, 0.15))
    assert [item.value for item in told(slide(25.0), *holds)] == [0.235]


def test_where_no_file_can_tell_the_engine_creep_is_a_warning():
    found = told(slide(25.0), HoldMotion("j0", {"j0": 0.15}, 0.1), soft=True)
    assert [str(item.severity) for item in found] == ["warning"]


def test_what_its_own_weight_should_move_does_not_creep():
    """2 kg along z weigh 19.62 N; along x nothing."""
    held = HoldMotion("j0", {"j0": 0.15}, 0.1)
    assert told(slide(21.0), held) == []
    assert len(told(slide(22.0), held)) == 1
    assert len(told(slide(0.1, (1.0, 0.0, 0.0)), held)) == 1


def test_infinity_while_held_rejects():
    (found,) = told(slide(25.0), HoldMotion("j0", {"j0": 0.15}, 0.0, finite=False))
    assert (found.code, str(found.severity)) == ("not_finite", "error")


def in_mujoco(folder, **press):
    path = restated(mjcf(button()), PRESS, damping="0.04", **press)(folder)
    return observe("mujoco", path, CONFIG, ())


@pytest.mark.skipif(not installed("mujoco"), reason="mujoco is not installed")
def test_mujoco_creeps_in_proportion_to_what_is_missing_to_a_hard_friction(tmp_path):
    """By g (1 - d) times half of the constraint's time of 20 ms, as in MuJoCo's own formula."""
    for impedance in (0.99, 0.999, 0.9999):
        stated = {"frictionloss": "1", "solimpfriction": f"{impedance} {impedance} 0.001"}
        (tmp_path / str(impedance)).mkdir()
        first = in_mujoco(tmp_path / str(impedance), **stated).holds[0]
        assert first.moved == pytest.approx(2.0 * 9.81 * (1.0 - impedance) * 0.01, rel=0.05)


@pytest.mark.skipif(not installed("mujoco"), reason="mujoco is not installed")
def test_a_spring_stronger_than_the_friction_is_not_creep(tmp_path):
    sprung = {"stiffness": "2000", "springref": "0", "solimpfriction": "0.9999 0.9999 0.001"}
    holds = in_mujoco(tmp_path, frictionloss="1", **sprung).holds
    # At a quarter of its 5 mm the spring pulls 2.5 N.
    assert holds == ()


@pytest.mark.skipif(not installed("pybullet"), reason="pybullet is not installed")
def test_pybullet_holds_what_little_more_friction_than_weight_should(tmp_path):
    friction = WEIGHT / 0.89
    rubbing = ("<limit ", f'<dynamics friction="{friction!r}" damping="0.04"/><limit ')
    path = edited(urdf(button()), rubbing)(tmp_path)
    observation = observe("pybullet", path, CONFIG, ())
    assert [item.moved for item in observation.holds] == pytest.approx([0.0] * 3, abs=1e-6)
    result = check_creep(read_description(path), "pybullet", observation, CheckConfig(), soft=False)
    assert result.findings == ()
    assert [row["load"] for row in result.measurements["hold"]] == pytest.approx([WEIGHT] * 3)
