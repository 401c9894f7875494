"""Nights with the real registry and real jobs."""

import json
from dataclasses import replace

import pytest
from registry_samples import publish

from asset_factory.factory.cli.nightly import Nightly, night_config, run
from asset_factory.factory.jobs.nightly.settings import NightBudget
from asset_factory.factory.jobs.nightly.work import Work
from asset_factory.factory.jobs.ray.executor import RayExecutor
from asset_factory.factory.registry import Registry

pytest.importorskip("pyarrow")


@pytest.fixture
def command(tmp_path):
    (tmp_path / "in").mkdir()
    (tmp_path / "night.toml").write_text(
        "inputs = ['in']\nsim = 'mujoco'\nworkers = 1\n[build]\narticulator = 'geometric'\n"
    )
    return Nightly(config=tmp_path / "night.toml", output=tmp_path / "out")


def test_a_night_without_inputs_makes_a_registry_and_says_so(command, capsys):
    assert run(command) == 0
    told = capsys.readouterr().out.splitlines()
    assert told[0] == "Night 0001: 0 of 0 inputs passed; 0 s."
    assert told[-1] == str(command.output / "nights" / "0001" / "index.html")
    assert Registry(command.output).entries() == ()


def test_damage_in_the_registry_is_found(command, capsys):
    folder = publish(Registry(command.output, create=True))
    assert run(command) == 0
    (folder / "asset.urdf").write_text("<robot />")
    assert run(command) == 4
    assert "Damaged: 1 registered asset" in capsys.readouterr().out
    data = json.loads((command.output / "nights" / "0002" / "summary.json").read_text())
    assert [(item["id"], item["code"]) for item in data["damage"]] == [("cabinet-1", "altered")]
    assert data["night"]["verified"] == 1


def test_budgets_and_executors_are_those_of_jobs(command):
    config = night_config(replace(command, executor="ray", ray_address="head:6379", workers=4))
    assert (Work(config).budget().max_s, Work(config).budget().limit) == (None, None)
    limits = NightBudget(max_hours=0.5, limit=7, retry_rejected=("build_timeout",))
    given = Work(replace(config, budget=limits)).budget()
    assert (given.max_s, given.limit, given.retry) == (1800.0, 7, ("build_timeout",))
    executor = Work(config).executor()
    assert isinstance(executor, RayExecutor)
    assert (executor.address, executor.workers) == ("head:6379", 4)
