"""Pairs that an SRDF exempts are warned of, counted, and reject nothing."""

import pytest
import trimesh
from ros_packages import write_package

from asset_factory.factory.cli.check import Check, run
from asset_factory.factory.errors import ConfigError
from asset_factory.sim_checks.read.roots import ReadOptions

SRDF = '<robot name="r"><disable_collisions link1="{}" link2="{}" reason="Adjacent"/></robot>'


def overlapping(folder):
    path = write_package(folder, "cabinet", "../meshes/")
    box = trimesh.creation.box((0.4, 0.3, 0.4))
    box.apply_translation((0.0, 0.147, 0.0))
    box.export(folder / "meshes" / "drawer.obj")
    return path


def test_exempt_pairs_are_told_and_reject_nothing(tmp_path, judge):
    path = overlapping(tmp_path)
    assert [finding.code for finding in judge.check(path, ()).errors] == ["rest_penetration"]
    path.with_suffix(".srdf").write_text(SRDF.format("drawer", "shell"))
    report = judge.check(path, ())
    assert not report.errors
    found = {finding.code: finding for finding in report.findings}
    assert found["pairs_exempt"].value == 1.0
    assert "drawer and shell" in found["pairs_exempt"].message
    assert "excluded_penetration" in found
    path.with_suffix(".srdf").write_text(SRDF.format("drawer", "no link"))
    assert [finding.code for finding in judge.check(path, ()).errors] == ["rest_penetration"]
    path.with_suffix(".srdf").write_text("<robot")
    assert [finding.code for finding in judge.check(path, ()).errors] == ["invalid_xml"]


def test_an_srdf_of_another_package_is_named(tmp_path, judge):
    path = overlapping(tmp_path / "description")
    srdf = tmp_path / "moveit" / "config" / "arm.srdf"
    srdf.parent.mkdir(parents=True)
    srdf.write_text(SRDF.format("drawer", "shell"))
    assert not judge.check(path, (), options=ReadOptions(srdf=srdf)).errors
    assert run(Check((path,), sim="", strict=True, srdf=srdf)) == 0
    for wrong in (Check((path, path), srdf=srdf), Check((path,), srdf=tmp_path / "no.srdf")):
        with pytest.raises(ConfigError, match="--srdf"):
            run(wrong)
