"""One call judges a file from anyone, and a bad file is a finding, never an exception."""

import os
import signal
from dataclasses import replace

import pytest
from box_world import write_drawer

from asset_factory.sim_checks import Status, run_checks
from asset_factory.sim_checks.checks import catalog
from asset_factory.sim_checks.config import CheckConfig, ChildConfig
from asset_factory.sim_checks.judge import examine_here


def test_a_sound_file_passes_with_its_clearance_measured(tmp_path):
    report = run_checks(write_drawer(tmp_path / "drawer.urdf", 0.003), ())
    assert report.passed
    (sweep,) = report.measurements["penetration"]["joints"]
    assert sweep["clearance_mm"] == pytest.approx(3.0, abs=0.1)
    assert report.measurements["lint"]["format"] == "urdf"


def test_an_unreadable_file_is_one_finding_and_no_simulator_is_asked(tmp_path):
    path = tmp_path / "bad.urdf"
    path.write_text("<robot")
    report = run_checks(path, ("sapien",))
    assert [finding.code for finding in report.findings] == ["invalid_xml"]
    assert not report.passed
    assert report.status is not Status.UNJUDGED


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


def test_a_check_that_takes_too_long_is_a_finding(tmp_path):
    config = replace(CheckConfig(), child=ChildConfig(wall_s=0.01))
    report = run_checks(write_drawer(tmp_path / "drawer.urdf", 0.003), (), config)
    assert report.errors[0].code == "check_timeout"


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
