"""One call judges a file from anyone, and one judge many: a bad file is a finding, and no other's.

What was judged before, and in what order, is nothing to the next.
"""

import os
import signal

import pytest
import trimesh
from box_world import write_drawer
from small_cabinet import LOOSE, write_mjcf, write_urdf

from asset_factory.sim_checks import Status, run_checks
from asset_factory.sim_checks.checks import catalog
from asset_factory.sim_checks.config import CheckConfig, ChildConfig
from asset_factory.sim_checks.judge import Judge, examine_here
from asset_factory.sim_checks.processes.isolation import Failure, Outcome, WarmChild
from asset_factory.sim_checks.simulators.catalog import installed

ENGINES = tuple(name for name in ("mujoco", "pybullet") if installed(name))


@pytest.fixture(scope="module")
def good(tmp_path_factory):
    return write_urdf(tmp_path_factory.mktemp("good"))


def test_neither_order_nor_workers_nor_a_crash_before_changes_a_byte(good, tmp_path):
    bad = write_drawer(tmp_path / "overlapping.urdf", -0.004)
    unreadable = tmp_path / "bad.urdf"
    unreadable.write_text("<robot")
    # Two roots: Bullet's loader dies of a segmentation fault, MuJoCo's does not.
    killer = write_urdf(tmp_path, LOOSE)
    (tmp_path / "mjcf").mkdir()
    files = (good, killer, bad, write_mjcf(tmp_path / "mjcf"), unreadable)
    alone = {path: run_checks(path, ENGINES) for path in files}
    assert alone[good].passed
    assert alone[good].measurements["lint"]["format"] == "urdf"
    assert [finding.code for finding in alone[unreadable].findings] == ["invalid_xml"]
    assert alone[unreadable].status is Status.REJECTED
    crashed = "simulator_crashed" in [finding.code for finding in alone[killer].findings]
    assert crashed is ("pybullet" in ENGINES)
    for workers, order in ((1, (good, killer, good, *files[2:])), (3, files[:1:-1])):
        with Judge(workers=workers) as judge:
            for path in order:
                assert judge.check(path, ENGINES).to_json() == alone[path].to_json()


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


@pytest.mark.parametrize(
    ("child", "code"),
    [
        # Enough for Python to start, and for nothing else.
        (ChildConfig(memory_bytes=200 * 2**20), "check_crashed"),
        (ChildConfig(wall_s=0.01), "check_timeout"),
    ],
    ids=["memory", "time"],
)
def test_a_child_that_asks_for_too_much_is_stopped(good, child, code):
    report = run_checks(good, ENGINES[:1], CheckConfig(child=child))
    assert report.errors[0].code == code
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


def test_an_unknown_simulator_is_wrong_usage(tmp_path):
    told = r"there are sapien, mujoco, pybullet, newton; did you mean 'mujoco'\?"
    with pytest.raises(ValueError, match=told):
        run_checks(write_drawer(tmp_path / "drawer.urdf", 0.003), ("mujcoo",))


def die(*_):
    os.kill(os.getpid(), signal.SIGSEGV)


def dying_examine(path, config, *, native=True):
    if native:
        catalog.check_penetration = die
    return examine_here(path, config, native=native)


def test_a_crash_of_the_check_is_a_finding_and_the_lint_still_speaks(tmp_path, monkeypatch):
    monkeypatch.setattr("asset_factory.sim_checks.judge.examine_here", dying_examine)
    report = run_checks(write_drawer(tmp_path / "drawer.urdf", 0.003), ())
    assert [finding.code for finding in report.errors] == ["check_crashed"]
    assert "SIGSEGV" in report.errors[0].message
    assert "lint" in report.measurements
    assert report.status is Status.UNJUDGED


BOX_MJCF = """<mujoco><worldbody><body name="shell"><geom type="box" size=".1 .1 .1"/>
<body name="drawer" pos="0 .21 0"><joint name="slide" type="slide" axis="0 1 0" range="0 .2"/>
<geom type="box" size=".1 .1 .1"/></body></body></worldbody></mujoco>"""


@pytest.mark.parametrize(
    ("simulators", "took_part", "status"),
    [
        ((), (), "passed"),
        (("sapien", "mujoco"), ("mujoco",), "passed"),
        (("sapien",), (), "unjudged"),
    ],
)
def test_who_took_part_is_named_and_a_file_that_nobody_drove_has_not_passed(
    tmp_path, simulators, took_part, status
):
    (tmp_path / "box.xml").write_text(BOX_MJCF)
    report = run_checks(tmp_path / "box.xml", simulators)
    assert (report.simulators, report.status) == (took_part, status)
    codes = [finding.code for finding in report.errors]
    assert ("not_simulated" in codes) is (status == "unjudged")
