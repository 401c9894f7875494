"""What MuJoCo does with a small cabinet and its broken kin."""

from __future__ import annotations

from pathlib import Path

import pytest
from small_cabinet import PARTS, codes, judge, motion_of, write_lid, write_mjcf, write_urdf

from asset_factory.sim_checks.report import Severity
from asset_factory.sim_checks.simulators.catalog import installed

pytestmark = pytest.mark.skipif(not installed("mujoco"), reason="MuJoCo is not installed")


@pytest.mark.parametrize("write", [write_urdf, write_mjcf])
def test_a_sound_cabinet_opens_and_closes_without_a_finding(tmp_path: Path, write: object) -> None:
    result = judge(write(tmp_path), "mujoco")  # type: ignore[operator]
    assert result.findings == ()
    assert motion_of(result, "slide")["reached"] > 0.99
    assert motion_of(result, "hinge")["returned"] < 0.01
    assert result.measurements["loading"]["worst_position_m"] < 1e-5


def test_a_drawer_wider_than_its_bay_is_jammed(tmp_path: Path) -> None:
    # 5 mm of overlap on each side.
    result = judge(write_mjcf(tmp_path, drawer_size=0.574), "mujoco")
    assert "jammed" in codes(result)
    assert motion_of(result, "slide")["reached"] < 0.5


def test_the_file_s_friction_is_overcome_by_the_drive_not_ignored(tmp_path: Path) -> None:
    result = judge(write_mjcf(tmp_path, friction=15.0), "mujoco")
    assert result.findings == ()
    assert motion_of(result, "slide")["reached"] > 0.95


def test_swapped_limits_are_lost_and_said_to_be(tmp_path: Path) -> None:
    swapped = {'lower="0" upper="0.3"': 'lower="0.3" upper="0"'}
    result = judge(write_urdf(tmp_path, replace=swapped), "mujoco")
    assert codes(result).count("limit_mismatch") == 2
    assert "not_driven" in codes(result, Severity.NOTE)


def test_a_needle_s_inertia_does_not_load(tmp_path: Path) -> None:
    path = write_urdf(tmp_path)
    text = path.read_text()
    start = text.index("<inertia ", text.index('<link name="door">'))
    needle = '<inertia ixx="1" iyy="0.001" izz="0.001" ixy="0" ixz="0" iyz="0"/>'
    path.write_text(text[:start] + needle + text[text.index("/>", start) + 2 :])
    result = judge(path, "mujoco")
    assert codes(result) == ["load_failed"]
    assert "inertia" in result.findings[0].message


def test_a_door_in_front_of_the_drawer_is_a_dependency_not_a_jam(tmp_path: Path) -> None:
    tall = (((-0.214, 0.0, 0.4), (0.018, 0.59, 0.78)),)
    wide_open = {'upper="1.57"': 'upper="2.6"'}
    result = judge(write_urdf(tmp_path, {**PARTS, "door": tall}, wide_open), "mujoco")
    assert codes(result) == []
    assert result.measurements["motion"]["dependencies"] == ["slide"]


def test_a_heavy_lid_opens_against_gravity_damping_and_friction(tmp_path: Path) -> None:
    result = judge(write_lid(tmp_path), "mujoco")
    assert codes(result) == []
    assert motion_of(result, "hinge")["reached"] > 0.99
