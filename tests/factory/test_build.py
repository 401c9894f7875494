"""One command turns meshes into registered assets; failures have a reason and cost no other."""

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest
import trimesh
from command_line import COMMAND

from asset_factory.factory.build import build_asset
from asset_factory.factory.cli.build import build_config
from asset_factory.factory.cli.commands import parse, run
from asset_factory.factory.config import BuildConfig

EXAMPLES = Path(__file__).resolve().parents[2] / "examples" / "meshes"
GENERATED = EXAMPLES.parent / "generated" / "fridge.glb"


def build(output, *arguments):
    """As a user does: in a process of its own, so that no test shares its fork server."""
    command = [*COMMAND, "build", "--output", str(output), *map(str, arguments)]
    done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=600)
    return done, json.loads((output / "summary.json").read_text())


def test_an_example_passes_in_all_three_simulators(tmp_path):
    output = tmp_path / "out"
    engines = "sapien,mujoco,pybullet"
    done, summary = build(output, "--input", EXAMPLES / "fridge.obj", "--sim", engines)
    assert done.returncode == 0, done.stderr
    assert (summary["inputs"], summary["passed"], summary["rejected"]) == (1, 1, 0), summary
    (row,) = summary["assets"]
    assert {"id", "input", "status", "reason", "joints", "hulls", "seconds"} <= set(row)
    assert row["joints"] == 2
    folder = output / "assets" / row["id"]
    files = {"asset.urdf", "asset.xml", "asset.json", "view.glb", "report.json", "meshes"}
    assert {path.name for path in folder.iterdir()} == files
    report = json.loads((folder / "report.json").read_text())
    assert report["passed"] is True
    assert report["simulators"] == ["sapien", "mujoco", "pybullet"]
    assert list((output / ".staging").iterdir()) == []
    assert (output / "report" / "index.html").is_file()
    # Lines are plain where there is no terminal.
    assert f"[1/1] passed: {row['id']}" in done.stderr
    assert "1 inputs: 1 passed, 0 rejected, 0 could not be validated." in done.stdout


def bad_inputs(folder):
    folder.mkdir()
    (folder / "broken.glb").write_bytes(b"glTF but not really")
    (folder / "empty.obj").write_text("# nothing\n")
    trimesh.creation.box().export(folder / "brick.stl")
    (folder / "nan.stl").write_text(
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex nan 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
        "endloop\nendfacet\nendsolid a\n"
    )
    (folder / "far.obj").write_text("mtllib ../../secret.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    return folder


def test_bad_inputs_are_rejected_with_a_reason_and_the_job_goes_on(tmp_path):
    output = tmp_path / "out"
    asked = ("--sim", "sapien", "--articulator", "geometric", "--no-report", "--strict")
    done, summary = build(output, "--input", bad_inputs(tmp_path / "in"), *asked)
    assert done.returncode == 1, done.stderr
    reasons = {Path(row["input"]).name: row["reason"] for row in summary["assets"]}
    assert reasons["broken.glb"] == "unreadable"
    assert reasons["empty.obj"] == "empty"
    assert reasons["brick.stl"] == "no_movable_joint"
    assert reasons["nan.stl"] == "not_finite"
    assert summary["rejected"] == summary["inputs"] == 5
    for row in summary["assets"]:
        report = json.loads((output / "rejected" / row["id"] / "report.json").read_text())
        assert report["passed"] is False
        assert report["findings"][0]["message"] == row["message"]


def test_what_is_left_is_said(tmp_path, capsys):
    trimesh.creation.box().export(tmp_path / "brick.stl")
    asked = ["build", "--input", str(tmp_path / "brick.stl"), "--output", str(tmp_path / "out")]
    for flags, state in (
        (["--limit", "0"], "limit_reached"),
        (["--max-hours", "0"], "out_of_time"),
    ):
        assert run([*asked, *flags]) == 0
        summary = json.loads((tmp_path / "out" / "summary.json").read_text())
        assert (summary["state"], summary["left"], summary["inputs"]) == (state, 1, 0)
        assert "1 inputs are left" in capsys.readouterr().out
    assert run([*asked, "--since", "2999-01-01"]) == 0


def test_overlapping_neighbours_are_rejected_with_the_millimetres(tmp_path):
    # Two drawers of one chest, modelled with 8 mm of overlap: no repair may hide that.
    parts = {
        "base": ("1 0.02 1", "0 0.265 0.5"),
        "one": ("0.5 0.5 0.4", "-0.246 0 0.5"),
        "two": ("0.5 0.5 0.4", "0.246 0 0.5"),
    }
    urdf = ['<robot name="chest">']
    for name, (size, center) in parts.items():
        urdf.append(
            f'<link name="{name}"><visual><origin xyz="{center}"/><geometry><box size="{size}"/>'
            "</geometry></visual></link>"
        )
        if name != "base":
            urdf.append(
                f'<joint name="slide_{name}" type="prismatic"><parent link="base"/>'
                f'<child link="{name}"/>'
                '<axis xyz="0 -1 0"/><limit lower="0" upper="0.3" effort="1" velocity="1"/></joint>'
            )
    (tmp_path / "chest.urdf").write_text("".join([*urdf, "</robot>"]))
    result = build_asset(tmp_path / "chest.urdf", tmp_path / "out", BuildConfig(simulators=()))
    assert (result.entry.status, result.entry.reason) == ("rejected", "rest_penetration")
    folder = tmp_path / "out" / "rejected" / result.entry.id
    report = json.loads((folder / "report.json").read_text())
    (finding,) = [f for f in report["findings"] if f["code"] == "rest_penetration"]
    assert finding["value"] == pytest.approx(8.0, abs=0.01)
    assert set(finding["parts"]) == {"one", "two"}
    assert finding["unit"] == "mm"
    assert np.isclose(finding["limit"], 2.0)


def test_a_generated_skin_opens_in_all_three_simulators(tmp_path):
    output = tmp_path / "out"
    asked = ("--input", GENERATED, "--sim", "sapien,mujoco,pybullet", "--no-report")
    _, summary = build(output, *asked)
    (row,) = summary["assets"]
    assert (row["status"], row["joints"]) == ("passed", 2), row
    manifest = json.loads((output / "assets" / row["id"] / "asset.json").read_text())
    assert [joint["kind"] for joint in manifest["joints"]] == ["revolute", "revolute"]
    surface = {"part", "kind", "rule", "thickness_m", "depth_m"}
    assert all(set(each) == surface for each in manifest["invented"])
    invented = {(each["part"], each["kind"]) for each in manifest["invented"]}
    assert {("base", "hollow"), ("door_0", "slab back"), ("door_1", "slab back")} <= invented


@pytest.mark.parametrize(("flags", "interior"), [((), True), (("--no-interior",), False)])
def test_an_interior_is_made_unless_a_flag_says_no(flags, interior):
    _, command = parse(["build", "--input", "x", "--output", "y", *flags])
    assert build_config(command).solids.interior is interior


@pytest.mark.full
def test_every_example_of_the_demo_passes(tmp_path):
    done, summary = build(
        tmp_path, "--input", EXAMPLES, EXAMPLES.parent / "generated", "--sim", "sapien"
    )
    assert done.returncode == 0
    assert {row["status"] for row in summary["assets"]} == {"passed"}, summary["assets"]
    assert len(summary["assets"]) == 11
