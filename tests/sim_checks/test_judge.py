"""One judge, many files: what was judged before, and in what order, is nothing to the next."""

import os

import pytest
import trimesh
from box_world import write_drawer
from small_cabinet import write_mjcf, write_urdf

from asset_factory.sim_checks import Status, run_checks
from asset_factory.sim_checks.config import CheckConfig, ChildConfig
from asset_factory.sim_checks.judge import Judge
from asset_factory.sim_checks.processes.isolation import Failure, Outcome, WarmChild
from asset_factory.sim_checks.simulators.catalog import installed

ENGINES = tuple(name for name in ("mujoco", "pybullet") if installed(name))


@pytest.fixture(scope="module")
def good(tmp_path_factory):
    return write_urdf(tmp_path_factory.mktemp("good"))


@pytest.fixture(scope="module")
def killer(tmp_path_factory):
    """Two roots: Bullet's loader dies of a segmentation fault, MuJoCo's does not."""
    return write_urdf(tmp_path_factory.mktemp("killer"), joints=False)


@pytest.mark.skipif("pybullet" not in ENGINES, reason="needs pybullet")
def test_a_file_that_kills_an_engine_costs_itself_its_verdict_and_the_next_one_nothing(
    good, killer
):
    alone = {path: run_checks(path, ENGINES).to_json() for path in (good, killer)}
    with Judge() as judge:
        reports = [judge.check(path, ENGINES) for path in (good, killer, good)]
    assert [report.to_json() for report in reports] == [alone[good], alone[killer], alone[good]]
    assert "simulator_crashed" in {finding.code for finding in reports[1].findings}
    assert reports[2].passed


def test_no_order_and_no_number_of_workers_changes_a_byte(tmp_path):
    bad = write_drawer(tmp_path / "overlapping.urdf", -0.004)
    unreadable = tmp_path / "bad.urdf"
    unreadable.write_text("<robot")
    files = (bad, write_mjcf(tmp_path), unreadable)
    alone = {path: run_checks(path, ENGINES).to_json() for path in files}
    for workers, order in ((1, files[::-1]), (3, (*files[1:], *files[:1]))):
        with Judge(workers=workers) as judge:
            for path in order:
                assert judge.check(path, ENGINES).to_json() == alone[path]


def test_a_file_that_was_changed_is_judged_as_it_is_now(tmp_path):
    # Engines remember meshes by name, and MuJoCo by the second they were written in.
    path = write_urdf(tmp_path)
    sound = trimesh.load(tmp_path / "drawer_hull_0.obj")
    wide = sound.copy()
    wide.apply_scale((1.0, 1.1, 1.0))
    with Judge() as judge:
        for mesh, passes in ((sound, True), (wide, False), (sound, True)):
            mesh.export(tmp_path / "drawer_hull_0.obj")
            os.utime(tmp_path / "drawer_hull_0.obj", (1e9, 1e9))
            report = judge.check(path, ENGINES)
            assert report.passed is passes
            engines = {finding.simulator for finding in report.errors if finding.code == "jammed"}
            assert ("mujoco" in engines) is (not passes and "mujoco" in ENGINES)


def test_what_was_examined_is_not_examined_again(good, monkeypatch):
    with Judge() as judge:
        whole = judge.check(good, ENGINES[:1])
        examined = judge.examine(good)
        monkeypatch.setattr(judge, "examine", None)
        assert judge.check(good, ENGINES[:1], examined).to_json() == whole.to_json()


def test_an_engine_that_asks_for_too_much_memory_is_stopped(good):
    # Enough for Python to start, and for nothing else.
    config = CheckConfig(child=ChildConfig(memory_bytes=200 * 2**20))
    report = run_checks(good, ENGINES[:1], config)
    assert report.errors[0].code == "check_crashed"
    assert report.status is Status.UNJUDGED


@pytest.mark.parametrize(
    ("error", "code", "stopped"),
    [
        (TimeoutError("hung"), "check_timeout", True),
        (ChildProcessError("ended"), "check_crashed", True),
        (RuntimeError("a fault of the program"), "check_crashed", False),
    ],
)
def test_what_stopped_a_reader_of_the_static_checks_is_told(
    error, code, stopped, tmp_path, monkeypatch
):
    outcome = Outcome(None, Failure.RAISED, str(error), "", 0.0, error=error)
    monkeypatch.setattr(WarmChild, "call", lambda *asked, **named: outcome)
    with Judge() as judge:
        report = judge.check(write_urdf(tmp_path), ())
    (finding,) = report.findings
    assert (finding.code, finding.stopped, report.status) == (code, stopped, Status.UNJUDGED)
