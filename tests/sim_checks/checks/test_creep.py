"""Joints that friction should hold, in worlds whose motion is known, and in MuJoCo and PyBullet."""

import numpy as np
import pytest
from box_world import built, sliding
from fault_corpus.exhibits import edited, mjcf, restated, urdf
from fault_corpus.good_things import button
from sliders import CONFIG, Sliders

from asset_factory.sim_checks.checks.creep import check_creep
from asset_factory.sim_checks.config import CheckConfig
from asset_factory.sim_checks.read.read import read_description
from asset_factory.sim_checks.simulators.catalog import installed, simulator
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


def slide(friction, axis=(0.0, 0.0, 1.0)):
    """A block of 2 kg that slides by 0.3 m along an axis."""
    return built(sliding("j0", [((0.0, 0.0, 0.5), (0.1, 0.1, 0.1))], axis, 0.3, friction=friction))


def told(description, *holds, soft=False):
    motions = (JointMotion("j0", 1.0, 0.0, 0.0, 0.0, 1.0, finite=True, range=0.3),)
    observation = Observation(None, motions=motions, holds=holds)
    engine = simulator("newton" if soft else "pybullet")
    return list(check_creep(description, engine, observation, CheckConfig()).findings)


def held(moved, at=0.15, **changes):
    return HoldMotion("j0", {"j0": at}, moved, **changes)


@pytest.mark.parametrize(("speed", "moved"), [(0.0, 0.0), (0.01, 0.02)], ids=["held", "creeping"])
def test_a_block_is_left_alone_at_three_values_and_watched_to_the_end(speed, moved):
    holds = creeping(speed, weight=19.62, friction=25.0)
    assert [item.values["j0"] for item in holds] == pytest.approx([0.075, 0.15, 0.225])
    assert [item.moved for item in holds] == pytest.approx([moved] * 3)


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
    ("description", "holds", "values"),
    [
        (slide(25.0), [held(0.0009)], []),
        (slide(25.0), [held(0.0011)], [0.0011]),
        (slide(25.0), [held(0.1)], [0.1]),
        (slide(25.0), [held(0.085, 0.075), held(0.235, 0.225), held(0.16, 0.15)], [0.235]),
        # 2 kg along z weigh 19.62 N; along x nothing.
        (slide(21.0), [held(0.1)], []),
        (slide(22.0), [held(0.1)], [0.1]),
        (slide(0.1, (1.0, 0.0, 0.0)), [held(0.1)], [0.1]),
    ],
    ids=["less than a millimetre", "more than a millimetre", "all the way", "the worst of three",
         "what its own weight should move", "what friction outweighs", "what weighs nothing"],
)  # fmt: skip
def test_a_millimetre_is_what_a_long_slide_may_creep(description, holds, values):
    found = [(x.code, x.value, x.unit, x.limit) for x in told(description, *holds)]
    assert found == [("creeps", value, "m", 0.001) for value in values]


@pytest.mark.parametrize(
    ("hold", "soft", "code", "severity"),
    [
        (held(0.1), False, "creeps", "error"),
        # No file can tell this engine to hold it.
        (held(0.1), True, "creeps", "warning"),
        (held(0.0, finite=False), False, "not_finite", "error"),
    ],
)
def test_creep_and_infinity_reject(hold, soft, code, severity):
    (found,) = told(slide(25.0), hold, soft=soft)
    assert (found.code, found.severity) == (code, severity)


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
    result = check_creep(read_description(path), simulator("pybullet"), observation, CheckConfig())
    assert result.findings == ()
    assert [row["load"] for row in result.measurements["hold"]] == pytest.approx([WEIGHT] * 3)
