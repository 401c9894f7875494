"""One command turns meshes into registered assets; failures have a reason and cost no other."""

import json
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
import trimesh
from command_line import COMMAND
from fault_corpus.things import Body, Move, Thing, at, box, write_urdf
from repository import EXAMPLES, MESHES

from asset_factory.factory.build import build_asset
from asset_factory.factory.cli.build import build_config
from asset_factory.factory.cli.commands import parse, run
from asset_factory.factory.config import BuildConfig


def build(output, *arguments):
    """As a user does: in a process of its own, so that no test shares its fork server."""
    command = [*COMMAND, "build", "--output", str(output), *map(str, arguments)]
    done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=600)
    return done, json.loads((output / "summary.json").read_text())


def test_an_example_and_a_generated_skin_pass_in_all_three_simulators(tmp_path):
    output = tmp_path / "out"
    inputs = (MESHES / "fridge.obj", EXAMPLES / "generated" / "fridge.glb")
    done, summary = build(output, "--input", *inputs, "--sim", "sapien,mujoco,pybullet")
    assert done.returncode == 0, done.stderr
    assert (summary["inputs"], summary["passed"], summary["rejected"]) == (2, 2, 0), summary
    files = {"asset.urdf", "asset.xml", "asset.json", "view.glb", "report.json", "meshes"}
    manifests = {}
    for row in summary["assets"]:
        assert {"id", "input", "status", "reason", "joints", "hulls", "seconds"} <= set(row)
        assert (row["status"], row["joints"]) == ("passed", 2)
        folder = output / "assets" / row["id"]
        assert {path.name for path in folder.iterdir()} == files
        report = json.loads((folder / "report.json").read_text())
        assert report["passed"] is True
        assert report["simulators"] == ["sapien", "mujoco", "pybullet"]
        # Lines are plain where there is no terminal.
        assert re.search(rf"^\[[12]/2\] passed: {row['id']}", done.stderr, re.MULTILINE)
        manifests[Path(row["input"]).name] = json.loads((folder / "asset.json").read_text())
    assert "2 inputs: 2 passed, 0 rejected, 0 could not be validated." in done.stdout
    assert list((output / ".staging").iterdir()) == []
    assert (output / "report" / "index.html").is_file()

    generated = manifests["fridge.glb"]
    assert [joint["kind"] for joint in generated["joints"]] == ["revolute", "revolute"]
    surface = {"part", "kind", "rule", "thickness_m", "depth_m"}
    assert all(set(each) == surface for each in generated["invented"])
    invented = {(each["part"], each["kind"]) for each in generated["invented"]}
    assert {("base", "hollow"), ("door_0", "slab back"), ("door_1", "slab back")} <= invented


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
    bodies = [Body("base", (box((0.0, 0.265, 0.5), (1.0, 0.02, 1.0)),), at(0.0, 0.0, 0.0), 1.0)]
    moves = []
    for name, x in (("one", -0.246), ("two", 0.246)):
        front = box((x, 0.0, 0.5), (0.5, 0.5, 0.4))
        bodies.append(Body(name, (front,), at(0.0, 0.0, 0.0), 1.0))
        out = (0.0, -1.0, 0.0)
        moves.append(Move(f"slide_{name}", "prismatic", "base", name, out, 0.0, 0.3))
    file = write_urdf(Thing("chest", tuple(bodies), tuple(moves)), tmp_path)
    result = build_asset(file, tmp_path / "out", BuildConfig(simulators=()))
    assert (result.entry.status, result.entry.reason) == ("rejected", "rest_penetration")
    folder = tmp_path / "out" / "rejected" / result.entry.id
    report = json.loads((folder / "report.json").read_text())
    (finding,) = [f for f in report["findings"] if f["code"] == "rest_penetration"]
    assert finding["value"] == pytest.approx(8.0, abs=0.01)
    assert set(finding["parts"]) == {"one", "two"}
    assert finding["unit"] == "mm"
    assert np.isclose(finding["limit"], 2.0)


@pytest.mark.parametrize(("flags", "interior"), [((), True), (("--no-interior",), False)])
def test_an_interior_is_made_unless_a_flag_says_no(flags, interior):
    _, command = parse(["build", "--input", "x", "--output", "y", *flags])
    assert build_config(command).solids.interior is interior


@pytest.mark.full
def test_every_example_of_the_demo_passes(tmp_path):
    done, summary = build(tmp_path, "--input", MESHES, EXAMPLES / "generated", "--sim", "sapien")
    assert done.returncode == 0
    assert {row["status"] for row in summary["assets"]} == {"passed"}, summary["assets"]
    assert len(summary["assets"]) == 11
