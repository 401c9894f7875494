"""What is published is whole; what is rejected says why; nothing is in two places."""

import errno
import json
import shutil
import sqlite3
from dataclasses import replace
from pathlib import Path
from unittest.mock import Mock

import pytest
from registry_samples import BAD_REPORT, PASSED, REJECTED, REPORT, publish

from asset_factory.factory.errors import RegistryError
from asset_factory.factory.manufacture.repair import Repair, RepairKind
from asset_factory.factory.registry import Registry
from asset_factory.factory.runtime.store import folder_digests


@pytest.fixture
def registry(tmp_path):
    return Registry(tmp_path / "out", create=True)


def test_a_published_asset_is_listed_and_whole_and_its_report_has_the_entry(registry):
    folder = publish(registry)
    assert registry.entries() == (PASSED,)
    assert (folder / "meshes" / "a.obj").read_text() == "one"
    assert list((registry.root / ".staging").iterdir()) == []
    report = json.loads((folder / "report.json").read_text())
    assert report["passed"] is True
    assert report["files"] == folder_digests(folder, without=("report.json",))
    assert report["entry"]["id"] == PASSED.id
    assert report["entry"]["license"] == "CC0-1.0"
    assert report["entry"]["split"] == PASSED.split
    assert not {"tags", "solved"} & set(report["entry"])
    assert registry.told(PASSED).report.passed


def test_repairs_are_told_as_they_were_registered_and_of_older_reports_by_their_sentences(registry):
    repair = Repair(RepairKind.LEFT_HOLLOW, ("lever",))
    told = replace(BAD_REPORT, repairs=(repair,))
    path = registry.add(REJECTED, told) / "report.json"
    assert registry.told(REJECTED) == told
    stored = json.loads(path.read_text())
    assert stored["repairs"] == [repair.sentence]
    path.write_text(json.dumps({**stored, "changes": None}))
    with pytest.raises(RegistryError, match="is none of a build"):
        registry.told(REJECTED)
    del stored["changes"]
    path.write_text(json.dumps(stored))
    (older,) = registry.told(REJECTED).repairs
    assert (older.kind, older.sentence) == (repair.kind, repair.sentence)


def test_an_asset_that_is_later_rejected_is_no_longer_published(registry):
    published = publish(registry)
    folder = registry.add(REJECTED, BAD_REPORT)
    assert not published.exists()
    assert registry.entries() == (REJECTED,)
    assert registry.told(REJECTED).report.errors[0].value == 5.0
    assert folder.parent == registry.rejected
    publish(registry)
    assert not folder.exists()
    assert registry.entries() == (PASSED,)


@pytest.mark.parametrize(
    ("number", "error", "told"),
    [(errno.ENOSPC, OSError, "no rename"), (errno.EXDEV, RegistryError, "another file system")],
    ids=["a full disk", "another file system"],
)
def test_a_bundle_that_cannot_be_renamed_publishes_nothing(
    registry, monkeypatch, number, error, told
):
    monkeypatch.setattr("os.rename", Mock(side_effect=OSError(number, "no rename")))
    with pytest.raises(error, match=told):
        publish(registry)
    monkeypatch.undo()
    assert registry.entries() == ()
    assert list(registry.assets.iterdir()) == []


def test_what_passed_has_files_and_an_id_is_the_name_of_a_folder(registry):
    with pytest.raises(RegistryError, match="has passed, and has no files"):
        registry.add(PASSED, REPORT)
    with pytest.raises(RegistryError, match=r"no entry: .*\$\.id`, in .*\.\./up"):
        registry.add(replace(REJECTED, id="../up"), BAD_REPORT)
    assert registry.entries() == ()
    assert not (registry.root / "up").exists()


def test_a_registry_moves_with_its_folder_and_who_may_not_write_can_read(
    registry, tmp_path, monkeypatch
):
    publish(registry)
    moved = Path(shutil.move(registry.root, tmp_path / "elsewhere"))
    for writable in (True, False):
        monkeypatch.setattr("os.access", lambda path, mode, writable=writable: writable)
        assert Registry(moved).entries() == (PASSED,)
        assert Registry(moved).told(PASSED).report.passed


def test_forgetting_takes_the_note_too_and_spares_the_exception(registry):
    publish(registry)
    registry.note(PASSED.id, tags=("a",))
    registry.forget(PASSED.id, except_id=PASSED.id)
    assert [entry.id for entry in registry.entries()] == [PASSED.id]
    registry.forget(PASSED.id)
    assert registry.entries() == ()
    assert list(registry.assets.iterdir()) == []
    assert not (registry.root / "notes" / f"{PASSED.id}.json").exists()
    registry.forget("never-there")


def test_the_same_bytes_again_change_nothing(registry):
    folder = publish(registry)
    before = folder.stat().st_ino
    publish(registry)
    assert folder.stat().st_ino == before
    (folder / "meshes" / "a.obj").write_text("altered")
    publish(registry)
    assert (folder / "meshes" / "a.obj").read_text() == "one"


def test_without_an_exchanging_rename_two_do(registry, monkeypatch):
    publish(registry)
    exchanged = "asset_factory.factory.registry.placing._exchanged"
    monkeypatch.setattr(exchanged, lambda first, second: errno.ENOSYS)
    assert (publish(registry, "two") / "meshes" / "a.obj").read_text() == "two"
    assert list((registry.root / ".staging").iterdir()) == []


def test_a_full_disk_is_no_damaged_database(registry, monkeypatch):
    full = sqlite3.OperationalError("database or disk is full")
    full.sqlite_errorcode = sqlite3.SQLITE_FULL
    monkeypatch.setattr("asset_factory.factory.registry.rows.insert", Mock(side_effect=full))
    with pytest.raises(OSError, match="No space left on device") as caught:
        publish(registry)
    assert caught.value.errno == errno.ENOSPC
