"""What is published is whole; what is rejected says why; nothing is in two places."""

import json
import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from asset_factory.factory.errors import RegistryError
from asset_factory.factory.registry import Entry, Registry
from asset_factory.sim_checks import Finding, Report, Severity

PASSED = Entry("cabinet-1", "cabinet", "cabinet", "passed", "", 3, 2, 9)
REJECTED = replace(PASSED, status="rejected", reason="rest_penetration")
REPORT = Report("asset.urdf").to_dict()
BAD_REPORT = Report(
    "asset.urdf", findings=(Finding("rest_penetration", Severity.HARD, "5 mm deep", value=5.0, unit="mm", limit=2.0),)
).to_dict()


@pytest.fixture
def registry(tmp_path):
    return Registry(tmp_path / "out", create=True)


def publish(registry, content="one"):
    with registry.staging_folder() as staging:
        bundle = staging / "bundle"
        (bundle / "meshes").mkdir(parents=True)
        (bundle / "meshes" / "a.obj").write_text(content)
        return registry.publish(PASSED, bundle, REPORT)


def test_a_published_asset_is_listed_and_whole(registry):
    folder = publish(registry)
    assert registry.entries() == (PASSED,)
    assert (folder / "meshes" / "a.obj").read_text() == "one"
    assert json.loads((folder / "report.json").read_text())["passed"] is True
    assert list(registry.staging.iterdir()) == []


def test_publishing_again_replaces(registry):
    publish(registry)
    folder = publish(registry, "two")
    assert (folder / "meshes" / "a.obj").read_text() == "two"
    assert registry.entries() == (PASSED,)


def test_an_asset_that_is_later_rejected_is_no_longer_published(registry):
    published = publish(registry)
    folder = registry.reject(REJECTED, BAD_REPORT)
    assert not published.exists()
    assert registry.entries() == (REJECTED,)
    assert registry.report(REJECTED).hard[0].value == 5.0
    assert folder.parent == registry.rejected
    publish(registry)
    assert not folder.exists()
    assert registry.entries() == (PASSED,)


def test_a_failure_before_the_rename_publishes_nothing(registry, monkeypatch):
    def broken(source, target):
        raise OSError("disk full")

    monkeypatch.setattr("os.rename", broken)
    with pytest.raises(OSError, match="disk full"):
        publish(registry)
    monkeypatch.undo()
    assert registry.entries() == ()
    assert list(registry.assets.iterdir()) == []


def test_only_what_passed_is_published(registry, tmp_path):
    with pytest.raises(RegistryError, match="status is 'rejected'"):
        registry.publish(REJECTED, tmp_path, REPORT)


def test_an_unknown_id_names_near_ones(registry):
    publish(registry)
    with pytest.raises(RegistryError, match="did you mean cabinet-1"):
        registry.entry("cabinet")
    with pytest.raises(RegistryError, match="shows all 1"):
        registry.entry("fridge")


def test_a_folder_without_a_registry_is_named(tmp_path):
    with pytest.raises(RegistryError, match="no registry here"):
        Registry(tmp_path)


def test_a_registry_moves_with_its_folder(registry, tmp_path):
    publish(registry)
    moved = Path(shutil.move(registry.root, tmp_path / "elsewhere"))
    assert Registry(moved).entries() == (PASSED,)


def test_forgetting_spares_the_exception(registry):
    publish(registry)
    registry.forget(PASSED.id, except_id=PASSED.id)
    assert registry.entries() == (PASSED,)
    registry.forget(PASSED.id)
    assert registry.entries() == ()
    assert list(registry.assets.iterdir()) == []
