"""Nights with the real registry and real jobs, in which something was broken between them."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
import trimesh
from registry_samples import named, publish

from asset_factory.factory.cli.nightly import Nightly, night_config, run
from asset_factory.factory.jobs.nightly.run import run_night
from asset_factory.factory.jobs.nightly.settings import NightBudget
from asset_factory.factory.jobs.nightly.work import Work
from asset_factory.factory.jobs.ray.executor import RayExecutor
from asset_factory.factory.registry import Registry
from asset_factory.factory.registry.verify import verify
from asset_factory.factory.runtime.store import folder_digests


@pytest.fixture
def command(tmp_path):
    (tmp_path / "in").mkdir()
    (tmp_path / "night.toml").write_text(
        "inputs = ['in']\nsim = 'mujoco'\nworkers = 1\n[build]\narticulator = 'rigid'\n"
    )
    return Nightly(config=tmp_path / "night.toml", output=tmp_path / "out")


def night(config):
    return run_night(config, Work(config))


def spoil(path):
    path.write_bytes(bytes(path.stat().st_size))


def test_a_night_without_inputs_makes_a_registry_and_says_so(command, capsys):
    assert run(command) == 0
    told = capsys.readouterr().out.splitlines()
    assert told[0] == "Night 0001: 0 of 0 inputs passed; 0 s."
    assert told[-1] == str(command.output / "nights" / "0001" / "index.html")
    assert Registry(command.output).entries() == ()


def test_budgets_and_executors_are_those_of_jobs(command):
    config = night_config(replace(command, executor="ray", ray_address="head:6379", workers=4))
    assert (Work(config).budget().max_s, Work(config).budget().limit) == (None, None)
    limits = NightBudget(max_hours=0.5, limit=7, retry_rejected=("build_timeout",))
    given = Work(replace(config, budget=limits)).budget()
    assert (given.max_s, given.limit, given.retry) == (1800.0, 7, ("build_timeout",))
    executor = Work(config).executor()
    assert isinstance(executor, RayExecutor)
    assert (executor.address, executor.workers) == ("head:6379", 4)


def test_a_night_mends_what_it_can_and_withdraws_nothing_before_inputs_are_begun(command, capsys):
    trimesh.creation.box((0.4, 0.3, 0.5)).export(command.output.parent / "in" / "box.stl")
    config = night_config(command)
    (first,) = night(config).attempts
    assert first.passed
    asset = config.output / "assets" / first.id
    before = folder_digests(asset)
    (asset / "asset.xml").unlink()
    short = night(replace(config, budget=replace(config.budget, max_hours=1e-9)))
    assert (short.settled, short.night.exit_code) == ({first.id: "left"}, 4)

    orphan = publish(Registry(config.output), entry=named("orphan-1"))
    # Files altered and missing, the cache spoiled, what dead processes left.
    spoil(asset / "asset.urdf")
    (orphan / "asset.urdf").unlink()
    for path in filter(Path.is_file, (config.output / ".cache").rglob("*")):
        spoil(path)
    (config.output / ".claims" / "of a dead job").touch()
    (config.output / ".staging" / "of a dead job").mkdir()
    assert run(command) == 4
    assert "Damaged: 2 registered assets" in capsys.readouterr().out
    told = json.loads((config.output / "nights" / "0003" / "summary.json").read_text())
    became = {item["id"]: item["became"] for item in told["damage"]}
    assert became == {first.id: "mended", "orphan-1": "withdrawn"}
    figures = [told["night"][name] for name in ("verified", "damaged", "mended", "withdrawn")]
    assert figures == [2, 2, 1, 1]
    assert folder_digests(asset) == before
    assert verify(Registry(config.output)) == ()
    assert list((config.output / ".claims").iterdir()) == []
    assert list((config.output / ".staging").iterdir()) == []
    assert (config.output / "withdrawn" / "orphan-1" / "report.json").is_file()

    again = night(config)
    assert (again.night.exit_code, again.night.known, again.night.damaged) == (0, 1, 0)
