"""What PyBullet does with a small cabinet and its broken kin."""

import pytest
from small_cabinet import PARTS, codes, judge, motion_of, write_lid, write_urdf

from asset_factory.sim_checks.checks.in_simulator import judge_in_simulator
from asset_factory.sim_checks.config import CheckConfig
from asset_factory.sim_checks.read.read import read_description
from asset_factory.sim_checks.simulators.catalog import installed

pytestmark = pytest.mark.skipif(not installed("pybullet"), reason="PyBullet is not installed")


def test_a_sound_cabinet_opens_and_closes_without_a_finding(tmp_path):
    result = judge(write_urdf(tmp_path), "pybullet")
    assert result.findings == ()
    assert motion_of(result, "slide")["reached"] > 0.99
    assert motion_of(result, "hinge")["returned"] < 0.01
    assert result.measurements["loading"]["worst_position_m"] < 1e-5


def test_two_roots_kill_the_engine_and_not_the_judge(tmp_path):
    result = judge(write_urdf(tmp_path, joints=False), "pybullet")
    assert codes(result) == ["simulator_crashed"]
    assert "SIGSEGV" in result.findings[0].message


def test_a_stop_in_its_own_carcass_jams_the_drawer_at_its_distance(tmp_path):
    stop = ((-0.31, 0.0, 0.6), (0.02, 0.5, 0.3))
    result = judge(
        write_urdf(tmp_path, {**PARTS, "carcass": (*PARTS["carcass"], stop)}), "pybullet"
    )
    assert "jammed" in codes(result)
    # 0.1 m of free way out of 0.3 m, less the margins.
    assert motion_of(result, "slide")["reached"] == pytest.approx(1 / 3, abs=0.02)


def test_overlap_across_the_travel_is_the_engine_s_blind_spot(tmp_path):
    wide = (((-0.015, 0.0, 0.5955), (0.37, 0.574, 0.363)),)
    result = judge(write_urdf(tmp_path, {**PARTS, "drawer": wide}), "pybullet")
    assert codes(result) == []
    assert any("across" in sentence for sentence in result.measurements["blind_spots"])


def test_a_missing_mesh_does_not_load(tmp_path):
    description = read_description(write_urdf(tmp_path))
    (tmp_path / "drawer_0.obj").unlink()
    result = judge_in_simulator(description, "pybullet", CheckConfig())
    assert set(codes(result)) & {"load_failed", "shape_dropped"}


def test_swapped_limits_are_lost_and_said_to_be(tmp_path):
    swapped = {'lower="0" upper="0.3"': 'lower="0.3" upper="0"'}
    assert (
        codes(judge(write_urdf(tmp_path, replace=swapped), "pybullet")).count("limit_mismatch") == 2
    )


def test_a_heavy_lid_opens_against_gravity_damping_and_friction(tmp_path):
    result = judge(write_lid(tmp_path), "pybullet")
    assert codes(result) == []
    assert motion_of(result, "hinge")["reached"] > 0.99
