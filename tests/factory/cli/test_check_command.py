"""`factory check` judges files and folders with one judge, prints at once, and names each path."""

from __future__ import annotations

import json
import re
import threading
from pathlib import Path

import pytest

from asset_factory.factory.cli import console
from asset_factory.factory.cli.commands import run
from asset_factory.sim_checks import Report
from asset_factory.sim_checks.judge import Judge

BODY = (
    '<inertial><origin xyz="{at}"/><mass value="1"/>'
    '<inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>'
    '<collision><origin xyz="{at}"/><geometry><box size="0.4 0.2 0.2"/></geometry></collision>'
)


def write(path: Path, gap: float) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    shell = BODY.format(at="0 0 0")
    drawer = BODY.format(at=f"0 {0.2 + gap} 0")
    path.write_text(
        f'<robot name="r"><link name="shell">{shell}</link><link name="drawer">{drawer}</link>'
        '<joint name="slide" type="prismatic"><parent link="shell"/>'
        '<child link="drawer"/><axis xyz="1 0 0"/>'
        '<limit lower="0" upper="0.3" effort="10" velocity="1"/></joint></robot>'
    )
    return path


def test_a_folder_is_judged_file_by_file_with_its_path_as_the_name(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write(tmp_path / "good" / "asset.urdf", 0.004)
    write(tmp_path / "bad" / "asset.urdf", -0.004)
    (tmp_path / "notes.xml").write_text("<notes/>")
    assert run(["check", str(tmp_path), "--sim", "", "--json", str(tmp_path / "report.json")]) == 0
    reports = json.loads((tmp_path / "report.json").read_text())
    assert [(r["description"], r["passed"]) for r in reports] == [
        ("bad/asset.urdf", False),
        ("good/asset.urdf", True),
    ]
    lines = capsys.readouterr().out.splitlines()
    assert [line.split(" (")[0] for line in lines if not line.startswith(" ")] == [
        "rejected bad/asset.urdf",
        "passed good/asset.urdf",
    ]


def test_one_file_gives_one_report_and_no_other_output(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write(tmp_path / "asset.urdf", 0.004)
    assert run(["check", str(path), "--sim", "", "--json", "-"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert (report["description"], report["passed"], report["disagreements"]) == (
        "asset.urdf",
        True,
        [],
    )


def test_reports_are_printed_as_they_come(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    files = [write(tmp_path / f"{name}.urdf", 0.004) for name in ("one", "two")]
    printed = threading.Event()
    check = Judge.check
    print_report = console.print_report

    def watched(judge: Judge, path: Path, *rest: object) -> object:
        assert path.stem == "one" or printed.wait(60.0)
        return check(judge, path, *rest)

    def noted(report: Report) -> None:
        print_report(report)
        printed.set()

    monkeypatch.setattr(Judge, "check", watched)
    monkeypatch.setattr(console, "print_report", noted)
    assert run(["check", *map(str, files), "--sim", "", "--workers", "1"]) == 0


def test_every_simulator_at_once_and_who_disagrees(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for engine in ("sapien", "mujoco", "pybullet"):
        pytest.importorskip(engine)
    path = write(tmp_path / "asset.urdf", -0.01)
    assert run(["check", str(path), "--sim", "all", "--strict"]) == 1
    out = capsys.readouterr().out
    assert "(sapien, mujoco, pybullet)" in out
    assert re.search(
        r"disagree opens slide: sapien pass \(1 of range\), mujoco jammed .* PhysX never collides",
        out,
    )


def test_missing_files_and_empty_folders_are_wrong_usage(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["check", str(tmp_path / "nowhere.urdf")]) == 2
    assert "nowhere.urdf: no such file" in capsys.readouterr().err
    assert run(["check", str(tmp_path)]) == 2
    assert f"no URDF, MJCF or USD file in {tmp_path}" in capsys.readouterr().err
    assert run(["check"]) == 2
    assert "no URDF, MJCF or USD file given" in capsys.readouterr().err


def test_many_files_are_judged_at_once_and_told_in_the_order_given(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    names = ["one", "two", "three"]
    files = [write(tmp_path / f"{name}.urdf", 0.004) for name in names]
    both = threading.Barrier(2)
    second_done = threading.Event()
    judges: set[int] = set()
    check = Judge.check

    def watched(judge: Judge, path: Path, *rest: object) -> object:
        judges.add(id(judge))
        if path.stem != "three":
            both.wait(60.0)
        if path.stem == "one":
            assert second_done.wait(60.0)
        report = check(judge, path, *rest)
        if path.stem == "two":
            second_done.set()
        return report

    monkeypatch.setattr(Judge, "check", watched)
    assert run(["check", *map(str, files), "--sim", "", "--workers", "2"]) == 0
    lines = [line for line in capsys.readouterr().out.splitlines() if not line.startswith(" ")]
    assert [line.split(" (")[0] for line in lines] == [f"passed {name}.urdf" for name in names]
    assert len(judges) == 2


def test_workers_have_to_be_some(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write(tmp_path / "asset.urdf", 0.004)
    assert run(["check", str(path), "--sim", "", "--workers", "0"]) == 2
    assert "--workers must be at least 1, not 0" in capsys.readouterr().err
