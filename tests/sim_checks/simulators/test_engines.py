"""What each engine does with a small cabinet and its broken kin."""

from collections import defaultdict
from contextlib import ExitStack
from dataclasses import replace

import pytest
from fault_corpus.things import box, with_body
from small_cabinet import CABINET, LOOSE, codes, motion_of, write_mjcf, write_urdf

from asset_factory.sim_checks import run_checks
from asset_factory.sim_checks.checks.in_simulator import judge_in_simulator
from asset_factory.sim_checks.config import CheckConfig
from asset_factory.sim_checks.processes.isolation import WarmChild
from asset_factory.sim_checks.read.read import read_here
from asset_factory.sim_checks.report import Severity
from asset_factory.sim_checks.simulators.catalog import installed


@pytest.fixture(scope="module")
def judge():
    """Judge a file in an engine, in one child for each; a mesh may get lost before that."""
    with ExitStack() as stack:
        children = defaultdict(lambda: stack.enter_context(WarmChild()))

        def judge(path, engine, lost=""):
            if not installed(engine):
                pytest.skip(f"{engine} is not installed")
            description = read_here(path)
            if lost:
                (path.parent / lost).unlink()
            return judge_in_simulator(description, engine, CheckConfig(), children[engine])

        yield judge


@pytest.mark.parametrize(
    ("engine", "write"),
    [
        ("sapien", write_urdf),
        ("pybullet", write_urdf),
        *((engine, write) for engine in ("mujoco", "newton") for write in (write_urdf, write_mjcf)),
    ],
)
def test_a_sound_cabinet_opens_and_closes_without_a_finding(tmp_path, judge, engine, write):
    result = judge(write(tmp_path), engine)
    assert result.findings == ()
    assert motion_of(result, "slide")["reached"] > 0.99
    assert motion_of(result, "hinge")["returned"] < 0.01
    loading = result.measurements["loading"]
    assert loading["worst_position_m"] < 1e-5
    assert loading["joints"] == 2
    # Bullet weighs no root that is fixed.
    assert loading["mass_kg"] == pytest.approx(5.0 if engine == "pybullet" else 25.0)


def test_a_door_in_front_of_the_drawer_is_a_dependency_not_a_jam(tmp_path, judge):
    tall = with_body(CABINET, "door", pieces=(box((-0.214, 0.0, 0.4), (0.018, 0.59, 0.78)),))
    result = judge(write_urdf(tmp_path, tall, {'upper="1.57"': 'upper="2.6"'}), "mujoco")
    assert codes(result) == []
    assert result.measurements["motion"]["dependencies"] == ["slide"]


@pytest.mark.parametrize("engine", ["mujoco", "pybullet"])
def test_swapped_limits_are_lost_and_said_to_be(tmp_path, judge, engine):
    swapped = {'lower="0.0" upper="0.3"': 'lower="0.3" upper="0"'}
    result = judge(write_urdf(tmp_path, replace=swapped), engine)
    assert codes(result).count("limit_mismatch") == 2
    assert engine == "pybullet" or "not_driven" in codes(result, Severity.NOTE)


def test_two_roots_are_refused_in_the_loader_s_own_words(tmp_path, judge):
    result = judge(write_urdf(tmp_path, LOOSE), "sapien")
    assert codes(result) == ["load_failed"]
    assert "Links are not all connected" in result.findings[0].message


@pytest.mark.parametrize("engine", ["sapien", "pybullet"])
def test_a_mesh_that_vanishes_is_a_dropped_shape_or_does_not_load(tmp_path, judge, engine):
    result = judge(write_urdf(tmp_path), engine, lost="drawer_hull_0.obj")
    found = [item for item in result.findings if item.code in ("shape_dropped", "load_failed")]
    assert found
    if engine == "sapien":
        assert (found[0].value, found[0].limit, found[0].parts) == (0.0, 1.0, ("drawer",))


def test_an_object_without_joints_loads_with_its_shapes(tmp_path, judge):
    carcass = replace(LOOSE, bodies=LOOSE.bodies[:1])
    result = judge(write_urdf(tmp_path, carcass), "sapien")
    assert result.findings == ()
    assert result.measurements["loading"]["shapes"] == len(carcass.bodies[0].pieces)


def test_newton_never_lets_a_link_touch_the_one_that_it_is_jointed_to(tmp_path, judge):
    result = judge(write_urdf(tmp_path), "newton")
    pairs = result.measurements["motion"]["pairs_enforced"]
    assert pairs["link_and_unmoved_parent"] == "pass through each other"
    assert pairs["siblings_and_further"] == "touch"


@pytest.mark.skipif(not installed("newton"), reason="newton is not installed")
def test_newton_agrees_with_mujoco(tmp_path):
    report = run_checks(write_urdf(tmp_path), ("mujoco", "newton"))
    assert report.simulators == ("mujoco", "newton")
    assert report.findings == ()
    assert report.disagreements == ()
