"""What Newton does with a small cabinet, and whether it agrees with MuJoCo's own reading of it."""

import pytest
from small_cabinet import PARTS, codes, judge, motion_of, write_mjcf, write_urdf

from asset_factory.sim_checks.run import run_checks
from asset_factory.sim_checks.simulators.catalog import installed

pytestmark = pytest.mark.skipif(not installed("newton"), reason="Newton is not installed")


@pytest.mark.parametrize("write", [write_urdf, write_mjcf])
def test_a_sound_cabinet_opens_and_closes_without_a_finding(tmp_path, write):
    result = judge(write(tmp_path), "newton")
    assert result.findings == ()
    assert motion_of(result, "slide")["reached"] > 0.99
    assert motion_of(result, "hinge")["returned"] < 0.01
    loading = result.measurements["loading"]
    assert loading["worst_position_m"] < 1e-5
    assert loading["joints"] == 2
    assert loading["mass_kg"] == pytest.approx(25.0)


def test_a_stopper_in_the_way_jams_the_drawer(tmp_path):
    stopper = (((-0.31, 0.0, 0.6), (0.02, 0.5, 0.3)),)
    result = judge(write_urdf(tmp_path, {**PARTS, "stopper": stopper}), "newton")
    assert "jammed" in codes(result)
    assert motion_of(result, "slide")["reached"] < 0.5


def test_it_never_lets_a_link_touch_the_one_that_it_is_jointed_to(tmp_path):
    result = judge(write_urdf(tmp_path), "newton")
    pairs = result.measurements["motion"]["pairs_enforced"]
    assert pairs["link_and_unmoved_parent"] == "pass through each other"
    assert pairs["siblings_and_further"] == "touch"


def test_it_agrees_with_mujoco(tmp_path):
    pytest.importorskip("mujoco")
    report = run_checks(write_urdf(tmp_path), ("mujoco", "newton"))
    assert report.simulators == ("mujoco", "newton")
    assert report.findings == ()
    assert report.disagreements == ()
