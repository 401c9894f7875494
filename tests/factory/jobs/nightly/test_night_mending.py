"""Nights over real builds, in which something was broken between them."""

from dataclasses import replace
from pathlib import Path

import pytest
import trimesh
from registry_samples import named, publish

from asset_factory.factory.cli.nightly import Nightly, night_config
from asset_factory.factory.jobs.nightly.run import run_night
from asset_factory.factory.jobs.nightly.work import Work
from asset_factory.factory.registry import Registry
from asset_factory.factory.registry.verify import verify
from asset_factory.factory.runtime.store import folder_digests

pytest.importorskip("pyarrow")
pytest.importorskip("mujoco")


@pytest.fixture
def config(tmp_path):
    (tmp_path / "in").mkdir()
    trimesh.creation.box((0.4, 0.3, 0.5)).export(tmp_path / "in" / "box.stl")
    (tmp_path / "night.toml").write_text(
        "inputs = ['in']\nsim = 'mujoco'\nworkers = 1\n[build]\narticulator = 'rigid'\n"
    )
    return night_config(Nightly(config=tmp_path / "night.toml", output=tmp_path / "out"))


def night(config):
    return run_night(config, Work(config))


def spoil(path):
    path.write_bytes(bytes(path.stat().st_size))


def test_a_night_mends_what_it_can(config):
    (first,) = night(config).attempts
    assert first.passed
    asset = config.output / "assets" / first.id
    before = folder_digests(asset)
    orphan = publish(Registry(config.output), entry=named("orphan-1"))
    # Files altered and missing, the cache spoiled, what dead processes left.
    spoil(asset / "asset.urdf")
    (asset / "asset.xml").unlink()
    (orphan / "asset.urdf").unlink()
    for path in filter(Path.is_file, (config.output / ".cache").rglob("*")):
        spoil(path)
    (config.output / ".claims" / "of a dead job").touch()
    (config.output / ".staging" / "of a dead job").mkdir()

    report = night(config)
    assert report.settled == {first.id: "mended", "orphan-1": "withdrawn"}
    assert (report.night.damaged, report.night.mended, report.night.withdrawn) == (2, 1, 1)
    assert report.night.exit_code == 4
    assert folder_digests(asset) == before
    assert verify(Registry(config.output)) == ()
    assert list((config.output / ".claims").iterdir()) == []
    assert list((config.output / ".staging").iterdir()) == []
    assert (config.output / "withdrawn" / "orphan-1" / "report.json").is_file()

    again = night(config)
    assert (again.night.exit_code, again.night.known, again.night.damaged) == (0, 1, 0)


def test_nothing_is_withdrawn_while_inputs_are_not_begun(config):
    (first,) = night(config).attempts
    (config.output / "assets" / first.id / "asset.urdf").unlink()
    short = replace(config, budget=replace(config.budget, max_hours=1e-9))
    report = night(short)
    assert (report.settled, report.night.exit_code) == ({first.id: "left"}, 4)
    assert night(config).settled == {first.id: "mended"}
