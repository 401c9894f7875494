"""``factory solve``: what is written, what is not done twice, and what the exit code says."""

import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from job_samples import Inline
from openable_samples import cabinet, valve, write_registry

from asset_factory.envs.solving import Attempt
from asset_factory.envs.solving.record import SolveRecord, read_record
from asset_factory.factory.cli import report
from asset_factory.factory.cli import solve as command
from asset_factory.factory.errors import Exit

pytest.importorskip("mani_skill", reason="mani_skill is not installed")


def found(asset, joint, robot="panda", **facts):
    return replace(Attempt(asset, "d", joint, robot, 0, solved=False), **facts)


@pytest.fixture
def output(tmp_path):
    write_registry(tmp_path, cabinet(), valve())
    return tmp_path


@pytest.fixture
def notes(monkeypatch):
    """What the registry was told, instead of a registry of built assets."""
    told = {}
    registry = SimpleNamespace(note=lambda asset, solved: told.update({asset: solved}))
    monkeypatch.setattr("asset_factory.factory.registry.Registry", lambda root: registry)
    return told


@pytest.fixture
def robots(monkeypatch):
    """Robots that open every hinge, and of which Fetch opens drawers too; what they were asked."""
    asked = []

    def attempted(task):
        asked.append((task.asset_id, task.joint, task.robot))
        solved = task.joint == "hinge" or asked[-1][1:] == ("slide", "fetch")
        facts = {} if solved else {"reason": "stuck", "message": "not moved by 50 N"}
        facts |= {"solved": solved, "seed": task.seed}
        return found(*asked[-1], actions=np.zeros((7, 8), np.float32), **facts)

    monkeypatch.setattr("asset_factory.factory.jobs.LocalExecutor", Inline)
    monkeypatch.setattr("asset_factory.envs.solving.solve.attempted", attempted)
    return asked


def test_fetch_tries_what_panda_could_not_open(output, notes, robots, capsys):
    assert command.run(command.Solve(output=output)) == Exit.OK
    unopened = [("cabinet", "slide"), ("valve", "wheel")]
    panda = [(*each, "panda") for each in [("cabinet", "hinge"), *unopened]]
    assert robots == panda + [(*each, "fetch") for each in unopened]
    assert notes == {"cabinet": "yes", "valve": "no"}
    printed = capsys.readouterr()
    assert printed.out.endswith("1 of 2 assets have at least one solved joint\n")
    assert "[fetch 1/2] cabinet slide: solved in 7 steps" in printed.err


def test_the_record_is_the_same_every_time_and_nothing_is_asked_twice(output, notes, robots):
    command.run(command.Solve(output=output))
    path = output / "solving" / "cabinet.json"
    first = path.read_bytes()
    questions = len(robots)
    command.run(command.Solve(output=output))
    assert len(robots) == questions
    path.unlink()
    command.run(command.Solve(output=output))
    assert path.read_bytes() == first
    row = json.loads(first)["attempts"][0]
    assert (row["joint"], row["robot"], row["solved"], row["steps"]) == ("hinge", "panda", True, 7)
    assert not {"seconds", "actions"} & set(row)


def test_a_video_of_what_is_solved_already_is_made(output, notes, robots, monkeypatch):
    command.run(command.Solve(output=output))
    filmed = []

    def film(_, attempt):
        filmed.append((attempt.joint, attempt.robot))
        (output / "solving" / f"{attempt.asset}-{attempt.joint}-{attempt.robot}.mp4").touch()

    monkeypatch.setattr(command, "_film", film)
    monkeypatch.setattr(report, "report_after", lambda *_: filmed.append("pages"))
    for _ in range(2):
        command.run(command.Solve(output=output, video=True))
    assert filmed == [("hinge", "panda"), ("slide", "fetch"), "pages", "pages"]


def test_an_altered_asset_and_more_tries_are_asked_again(output, notes, robots):
    command.run(command.Solve(output=output, robot="panda"))
    robots.clear()
    command.run(command.Solve(output=output, robot="panda", tries=9))
    assert robots == [("cabinet", "slide", "panda"), ("valve", "wheel", "panda")]
    robots.clear()
    manifest = output / "assets" / "valve" / "asset.json"
    manifest.write_text(manifest.read_text() + "\n")
    command.run(command.Solve(output=output, robot="panda", tries=9))
    assert robots == [("valve", "wheel", "panda")]


def test_strict_tells_of_assets_that_nobody_opened(output, notes, robots):
    assert command.run(command.Solve(output=output, strict=True)) == Exit.REJECTED
    assert command.run(command.Solve(ids=("cabinet",), output=output, strict=True)) == Exit.OK


def test_one_joint_is_no_verdict_on_the_others(output, notes, robots):
    command.run(command.Solve(ids=("cabinet",), output=output, joint="slide", robot="panda"))
    assert robots == [("cabinet", "slide", "panda")]
    assert notes == {}


def test_what_could_not_be_tried_is_asked_again_and_is_no_verdict():
    late = found("cabinet", "hinge", reason="timeout", message="no answer")
    record = SolveRecord("cabinet", "d").noting(late, 4)
    assert record.wants("hinge", "panda", 0, 4)
    assert record.verdict(["hinge"]) == ""
    record = record.noting(found("cabinet", "hinge", reason="stuck", message="not moved"), 4)
    assert not record.wants("hinge", "panda", 0, 4)
    assert record.wants("hinge", "panda", 0, 5)
    assert record.verdict(["hinge"]) == "no"


@pytest.mark.parametrize(
    "text", ["", "[]", '{"version": 1}', '{"version": 1, "digest": "d", "attempts": [{}]}']
)
def test_a_record_that_cannot_be_read_counts_as_none(tmp_path, text):
    (tmp_path / "solving").mkdir()
    (tmp_path / "solving" / "cabinet.json").write_text(text)
    assert read_record(tmp_path, "cabinet", "d") == SolveRecord("cabinet", "d")
