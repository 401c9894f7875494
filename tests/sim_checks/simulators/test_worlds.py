"""Every engine's world alike: weight, energy, axis, friction, named blockers, no trace left."""

import math
from contextlib import closing
from dataclasses import replace

import numpy as np
import pytest
from box_world import joint_text
from box_world import write_urdf as write_boxes
from engines import skipped_if_missing
from fault_corpus.things import Body, Move, Thing, at, box, with_body
from fault_corpus.things import write_urdf as write_thing
from small_cabinet import CABINET, codes, rows, stopped, write_lid, write_urdf

from asset_factory.sim_checks.checks.motion import check_motion
from asset_factory.sim_checks.config import CheckConfig, MotionConfig
from asset_factory.sim_checks.processes.isolation import Limits, run_isolated
from asset_factory.sim_checks.read.read import read_description
from asset_factory.sim_checks.report import Severity
from asset_factory.sim_checks.simulators.catalog import SIMULATORS, simulator
from asset_factory.sim_checks.simulators.observe import observe
from asset_factory.sim_checks.simulators.rest import fall, rest

CONFIG = MotionConfig()
ENGINES = skipped_if_missing(*SIMULATORS)
PENDULUM = """<robot name="pendulum"><link name="post"><inertial><mass value="1"/>
  <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="arm"><inertial><origin xyz="0.5 0 0" rpy="0.3 0.2 0.1"/><mass value="2"/>
  <inertia ixx="0.02" iyy="0.03" izz="0.04" ixy="0.001" ixz="0" iyz="0"/></inertial></link>
  <joint name="swing" type="revolute"><parent link="post"/><child link="arm"/>
  <origin xyz="0 0 1" rpy="0 0 0.7"/><axis xyz="0 1 0"/>
  <limit lower="0" upper="3.1" effort="1" velocity="9"/></joint></robot>"""


@pytest.fixture(params=ENGINES)
def engine(request):
    return request.param


def opened(path, engine):
    return closing(simulator(engine).open(path, CONFIG))


@pytest.fixture
def pendulum(tmp_path, engine):
    """A swinging arm in an engine."""
    with opened(written(tmp_path, PENDULUM), engine) as world:
        yield world


def judged(path, engine):
    """The motion check in this process, where each engine is imported but once."""
    return check_motion(read_description(path), observe(engine, path, CONFIG, ()), CheckConfig())


def written(folder, text, name="object.urdf"):
    path = folder / name
    path.write_text(text)
    return path


def test_what_has_no_limits_turns_on_after_a_whole_turn(tmp_path, engine):
    spinner = PENDULUM.replace('type="revolute"', 'type="continuous"')
    spinner = spinner.replace('axis xyz="0 1 0"', 'axis xyz="0 0 1"')
    with opened(written(tmp_path, spinner), engine) as world:
        world.place(np.array([6.2]))
        angles = []
        for _ in range(120):
            world.step(world.balance() + 20.0 * (10.0 - world.velocities()))
            angles.append(float(world.positions()[0]))
        assert angles[-1] > 7.5
        assert np.abs(np.diff(angles)).max() < 0.1


def test_a_pendulum_keeps_its_energy_and_a_weightless_one_its_place(pendulum):
    pendulum.place(np.array([0.3]))
    before = pendulum.energy()
    energies = []
    for _ in range(120):
        pendulum.step(np.zeros(1))
        energies.append(pendulum.energy() - before)
    fallen = 2.0 * 9.81 * 0.5 * (math.sin(float(pendulum.positions()[0])) - math.sin(0.3))
    assert fallen > 3.0
    # What a first-order step of 1/240 s gains, and what Bullet's own drag of 4 % a second
    # takes.
    assert max(energies) < 0.03 * fallen
    assert min(energies) > -0.1 * fallen
    pendulum.weigh(False)
    pendulum.place(np.array([0.3]))
    for _ in range(120):
        pendulum.step(np.zeros(1))
    assert pendulum.positions()[0] == pytest.approx(0.3, abs=1e-6)
    assert pendulum.energy() == pytest.approx(0.0, abs=1e-9)


def test_kinetic_energy_is_half_the_moment_of_inertia_times_speed_squared(pendulum):
    pendulum.weigh(False)
    pendulum.place(np.array([0.3]))
    for _ in range(60):
        pendulum.step(np.array([1.0]))
    inertia = float(pendulum.mass_matrix()[0, 0])
    speed = float(pendulum.velocities()[0])
    assert inertia == pytest.approx(0.53, rel=0.02)
    assert speed == pytest.approx(0.25 / inertia, rel=0.01)
    assert pendulum.energy() == pytest.approx(0.5 * inertia * speed**2, rel=1e-4)


def test_nothing_is_put_to_sleep(pendulum):
    pendulum.weigh(False)
    pendulum.place(np.array([0.3]))
    for _ in range(240):
        pendulum.step(np.array([1e-3]))
    speed = float(pendulum.velocities()[0])
    before = float(pendulum.positions()[0])
    assert 1e-3 < speed < 2e-3
    for _ in range(480):
        pendulum.step(np.zeros(1))
    # Two seconds at that speed, less Bullet's drag.
    assert float(pendulum.positions()[0]) - before == pytest.approx(2.0 * speed, rel=0.1)


def test_an_arm_opens_by_its_weight_and_neither_rests_nor_falls_with_made_up_energy(
    tmp_path, engine
):
    with opened(written(tmp_path, PENDULUM), engine) as world:
        (resting,) = rest(world, CONFIG)
        fallen = fall(world, CONFIG)
    assert (resting.drift, resting.energy) == (0.0, 0.0)
    assert fallen.joints[0].share > 0.95
    assert fallen.energy_height < 0.1 * CONFIG.energy_soft_m
    findings = judged(written(tmp_path, PENDULUM), engine).findings
    assert [f.joint for f in findings if f.code == "opens_by_itself"] == ["swing"]


def test_what_hangs_on_its_stop_does_not_open_by_itself(tmp_path, engine):
    """A heavy lid, which opens against gravity, damping and friction."""
    result = judged(write_lid(tmp_path), engine)
    assert codes(result) == []
    assert "opens_by_itself" not in codes(result, Severity.WARNING)
    assert rows(result)["hinge"]["reached"] > 0.99
    # 20 kg, 0.3 m from the hinge.
    assert rows(result)["hinge"]["weight_closed"] == pytest.approx(20 * 9.81 * 0.3, rel=1e-4)
    assert abs(rows(result)["hinge"]["weight_open"]) < 2.0


def test_the_axis_arrives_in_the_child_s_frame_and_friction_with_the_shape(tmp_path, engine):
    shape = '<collision><geometry><box size=".1 .1 .1"/></geometry></collision>'
    text = PENDULUM.replace('<axis xyz="0 1 0"/>', '<axis xyz="0.6 0 -0.8"/>')
    text = text.replace("</link>\n  <joint", f"{shape}</link>\n  <joint")
    with opened(written(tmp_path, text), engine) as world:
        (joint,) = world.model.joints
        friction = {link.name: link.friction for link in world.model.links}
        carried = world.carried
    assert joint.axis == pytest.approx((0.6, 0.0, -0.8), abs=1e-6)
    assert friction["post"] is None
    usual = {"sapien": 0.3, "mujoco": 1.0, "pybullet": 0.5, "newton": 1.0}
    assert friction["arm"] == pytest.approx(usual[engine])
    assert carried == (frozenset({"arm"}),)


def test_a_jam_names_the_stopper(tmp_path, engine):
    result = judged(write_urdf(tmp_path, stopped()), engine)
    motion = rows(result)["slide"]
    assert motion["blocked_by"] == ["drawer", "stopper"]
    assert motion["stuck_at"] == pytest.approx(0.1, abs=0.01)
    assert motion["opening_force"] == pytest.approx(motion["force_bound"])
    (jam,) = [finding for finding in result.findings if finding.code == "jammed"]
    assert "'drawer' presses on 'stopper'" in jam.message


def test_siblings_that_lie_in_one_another_push_and_are_named(tmp_path, engine):
    cube = (0.2, 0.2, 0.2)
    boxes = {"base": ((0, 5, 0), cube), "a": ((0, 0, 0), cube), "b": ((0.12, 0, 0), cube)}
    slides = joint_text("a", "-1 0 0", 0.5) + joint_text("b", "1 0 0", 0.5)
    result = judged(write_boxes(tmp_path, boxes, slides), engine)
    pushed = [f for f in result.findings if f.code == "pushed_at_rest"]
    assert {f.joint for f in pushed} == {"a_joint", "b_joint"}
    assert all("'a' and 'b' overlap" in f.message for f in pushed)


# The others never let a link touch the one that it is jointed to.
@pytest.mark.parametrize("engine", ENGINES[1:3])
@pytest.mark.parametrize(("depth", "expected"), [(0.02, []), (0.07, ["warning"]), (0.2, ["error"])])
def test_a_part_shot_out_of_another_made_energy_from_nowhere(tmp_path, engine, depth, expected):
    cube = (0.8, 0.8, 0.8)
    boxes = {"base": ((0.0, 0.0, 0.0), cube), "a": ((0.8 - depth, 0.0, 0.0), cube)}
    result = judged(write_boxes(tmp_path, boxes, joint_text("a", "1 0 0", 2)), engine)
    shots = [f for f in result.findings if f.code == "energy_grows"]
    assert [str(shot.severity) for shot in shots] == expected
    for shot in shots:
        # 1 kg, and what would lift it by 5 cm.
        assert (shot.joint, shot.unit, shot.limit) == ("a_joint", "J", pytest.approx(0.05 * 9.81))
        assert shot.value > 0.05 * 9.81


def numbers_in_turn(engine, paths, samples):
    """Every number in full of what is seen of each file."""
    told = []
    for path in paths:
        seen = observe(engine, path, CONFIG, samples)
        poses = [{name: pose.tobytes() for name, pose in each.poses.items()} for each in seen.poses]
        told.append((repr(replace(seen, poses=())), poses))
    return told


def test_what_was_looked_at_before_leaves_no_trace(tmp_path, engine):
    # One that jams and pushes, so that contact solvers have much to remember.
    wide = with_body(CABINET, "drawer", pieces=(box((-0.015, 0, 0.5955), (0.37, 0.574, 0.363)),))
    (tmp_path / "one").mkdir()
    (tmp_path / "two").mkdir()
    jammed = write_urdf(tmp_path / "one", stopped(wide))
    path = write_urdf(tmp_path / "two", stopped())
    # In a process of its own: other tests leave settings in this one.
    asked = (engine, (path, jammed, path), ({"slide": 0.1, "hinge": 0.5},))
    before, _, after = run_isolated(numbers_in_turn, *asked, limits=Limits(wall_s=60.0)).unwrap()
    assert after == before


#: Where the button comes down to as the door swings open.
STOP = box((0.0, -1.75, -0.07), (0.1, 0.4, 0.3))


def button_door(*more):
    """A door that swings down about its lower edge, a button on it; the frame may have more."""
    bodies = (
        Body("frame", (box((0.0, 0.5, 1.0), (1.0, 0.5, 2.0)), *more), at(0, 0, 0), 40.0),
        Body("door", (box((0.0, 0.2, 1.0), (1.0, 0.04, 2.0)),), at(0.0, 0.2, 0.0), 15.0),
        Body("button", (box((0.0, 0.14, 1.9), (0.04, 0.02, 0.04)),), at(0.0, 0.14, 1.9), 0.01),
    )
    moves = (
        Move("hinge", "revolute", "frame", "door", (1.0, 0.0, 0.0), 0.0, 1.5),
        Move("press", "prismatic", "door", "button", (0.0, 1.0, 0.0), 0.0, 0.02),
    )
    return Thing("button_door", bodies, moves)


@pytest.mark.parametrize(("stop", "seen"), [((), False), ((STOP,), True)], ids=["free", "pressed"])
def test_a_button_on_a_door_is_moved_by_what_presses_it_only(tmp_path, engine, stop, seen):
    hinge = rows(judged(write_thing(button_door(*stop), tmp_path), engine))["hinge"]
    # What is pressed on the way has to make way first: it is tried pressed in.
    assert hinge["needs_open"] == (["press"] if seen else [])
    assert (hinge["reached"] > 0.99, hinge["others_moved"] < 0.5) == (True, True)


def chain(links):
    """Boxes of 0.1 m, each hinged to the one before, 1 cm apart."""
    bodies = tuple(
        Body(f"l{i}", (box((0.11 * i + 0.05, 0, 0), (0.1, 0.05, 0.05)),), at(0.11 * i, 0, 0), 0.125)
        for i in range(links)
    )
    moves = tuple(
        Move(f"j{i}", "revolute", f"l{i - 1}", f"l{i}", (0.0, 0.0, 1.0), 0.0, 0.1)
        for i in range(1, links)
    )
    return Thing("chain", bodies, moves)


def test_a_joint_of_a_chain_is_driven_without_shaking_the_others(tmp_path, engine):
    result = judged(write_thing(chain(10), tmp_path), engine)
    assert [finding for finding in result.findings if finding.severity is Severity.ERROR] == []
    assert max(row["others_moved"] for row in result.measurements["joints"]) < 0.01


def test_what_a_loader_says_is_told_without_places_in_the_code(tmp_path):
    pytest.importorskip("mujoco", reason="mujoco is not installed")
    written(tmp_path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\n"
            "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2/1 3 4\n", "a.obj")  # fmt: skip
    geom = '<asset><mesh name="a" file="a.obj"/></asset><worldbody><body><geom type="mesh"'
    joint = '<joint name="slide" type="slide" range="0 1" limited="true"/></body></worldbody>'
    path = written(tmp_path, f'<mujoco>{geom} mesh="a"/>{joint}</mujoco>', "object.xml")
    # In a process of its own, where a warning is no error.
    observed = run_isolated(observe, "mujoco", path, CONFIG, (), limits=Limits(wall_s=60.0))
    said = observed.unwrap().loader_lines
    assert said
    assert all(".py:" not in line and str(tmp_path) not in line for line in said)
