"""What SAPIEN does with a small cabinet and its broken kin."""

from __future__ import annotations

from pathlib import Path

import pytest
from small_cabinet import PARTS, codes, judge, motion_of, write_lid, write_mjcf, write_urdf

from asset_factory.sim_checks.checks.in_simulator import judge_in_simulator
from asset_factory.sim_checks.config import CheckConfig
from asset_factory.sim_checks.read.read import read_description
from asset_factory.sim_checks.report import Severity
from asset_factory.sim_checks.simulators.catalog import installed

pytestmark = pytest.mark.skipif(not installed("sapien"), reason="SAPIEN is not installed")


def test_a_sound_cabinet_opens_and_closes_without_a_finding(tmp_path: Path) -> None:
    result = judge(write_urdf(tmp_path), "sapien")
    assert result.findings == ()
    assert motion_of(result, "slide")["reached"] > 0.99
    assert motion_of(result, "hinge")["returned"] < 0.01
    assert result.measurements["loading"]["worst_position_m"] < 1e-5


def test_a_mesh_that_vanishes_is_a_dropped_shape(tmp_path: Path) -> None:
    path = write_urdf(tmp_path)
    description = read_description(path)
    (tmp_path / "drawer_0.obj").unlink()
    result = judge_in_simulator(description, "sapien", CheckConfig())
    dropped = next(f for f in result.findings if f.code == "shape_dropped")
    assert (dropped.value, dropped.limit, dropped.parts) == (0.0, 1.0, ("drawer",))


def test_two_roots_do_not_load(tmp_path: Path) -> None:
    result = judge(write_urdf(tmp_path, joints=False), "sapien")
    assert codes(result) == ["load_failed"]
    assert "Links are not all connected" in result.findings[0].message


def test_an_object_without_joints_loads_with_its_shapes(tmp_path: Path) -> None:
    result = judge(write_urdf(tmp_path, {"carcass": PARTS["carcass"]}), "sapien")
    assert result.findings == ()
    assert result.measurements["loading"]["shapes"] == len(PARTS["carcass"])


def test_a_stopper_in_the_way_jams_the_drawer_at_its_distance(tmp_path: Path) -> None:
    stopper = (((-0.31, 0.0, 0.6), (0.02, 0.5, 0.3)),)
    result = judge(write_urdf(tmp_path, {**PARTS, "stopper": stopper}), "sapien")
    assert codes(result) == ["jammed"]
    # 0.1 m of free way out of 0.3 m.
    assert motion_of(result, "slide")["reached"] == pytest.approx(1 / 3, abs=0.02)


def test_a_drawer_stuck_in_its_own_carcass_is_the_engine_s_blind_spot(tmp_path: Path) -> None:
    wide = (((-0.015, 0.0, 0.5955), (0.37, 0.574, 0.363)),)
    result = judge(write_urdf(tmp_path, {**PARTS, "drawer": wide}), "sapien")
    assert codes(result) == []
    assert any("parent and child" in sentence for sentence in result.measurements["blind_spots"])


def test_an_inertia_of_zero_is_not_silently_replaced(tmp_path: Path) -> None:
    path = write_urdf(tmp_path)
    text = path.read_text()
    start = text.index("<inertia ", text.index('<link name="door">'))
    zero = '<inertia ixx="0" iyy="0" izz="0" ixy="0" ixz="0" iyz="0"/>'
    path.write_text(text[:start] + zero + text[text.index("/>", start) + 2 :])
    assert {"mass_mismatch", "inertia_mismatch"} <= set(codes(judge(path, "sapien")))


def test_dropped_joint_friction_is_said(tmp_path: Path) -> None:
    edit = {"</joint>\n</robot>": '<dynamics friction="0.3" damping="0.2"/></joint>\n</robot>'}
    result = judge(write_urdf(tmp_path, replace=edit), "sapien")
    assert codes(result) == []
    assert codes(result, Severity.NOTE) == ["friction_ignored"]


def test_mjcf_is_not_judged_and_says_so(tmp_path: Path) -> None:
    result = judge(write_mjcf(tmp_path), "sapien")
    assert codes(result) == []
    assert codes(result, Severity.NOTE) == ["format_not_loaded"]


def test_a_heavy_lid_opens_against_gravity_damping_and_friction(tmp_path: Path) -> None:
    result = judge(write_lid(tmp_path), "sapien")
    assert codes(result) == []
    assert motion_of(result, "hinge")["reached"] > 0.99
