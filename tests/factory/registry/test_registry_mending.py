"""Damage without an input: rows are made anew, additions moved aside, lost assets withdrawn."""

import shutil
from dataclasses import replace

import pytest
from registry_samples import publish

from asset_factory.factory.intake.discover import find_inputs
from asset_factory.factory.registry import verify as verify_module
from asset_factory.factory.registry.aside import set_asset_aside
from asset_factory.factory.registry.database import writing
from asset_factory.factory.registry.rows import RegistryRow, delete, insert
from asset_factory.factory.registry.verify import Settled, mend_rows, settle, verify
from asset_factory.factory.runtime.layout import WITHDRAWN
from asset_factory.factory.runtime.store import folder_digests


def mended(registry, *, final=True):
    problems = verify(registry)
    mend_rows(registry, problems)
    return settle(registry, problems, final=final)


def test_rows_are_made_anew_from_the_folders(registry):
    before = registry.entries()
    with writing(registry.root) as connection:
        delete(connection, "fridge-1")
        record = replace(registry.entry("cabinet-1"), hulls=99)
        insert(connection, (RegistryRow(record, ""),))
    assert mended(registry) == {"cabinet-1": "mended", "fridge-1": "mended"}
    assert registry.entries() == before


def test_a_row_without_a_folder_goes(registry):
    shutil.rmtree(registry.assets / "fridge-1")
    assert mended(registry) == {"fridge-1": Settled.WITHDRAWN}
    assert registry.find("fridge-1") is None
    assert verify(registry) == ()


def test_what_was_added_is_moved_aside_and_the_asset_stays(registry):
    folder = registry.assets / "cabinet-1"
    before = folder_digests(folder)
    for content in ("first", "second"):
        (folder / "meshes" / ".DS_Store").write_text(content)
        assert mended(registry) == {"cabinet-1": Settled.MENDED}
    assert folder_digests(folder) == before
    aside = registry.root / "withdrawn" / "cabinet-1" / "meshes" / ".DS_Store"
    assert aside.read_text() == "second"


def test_what_nothing_can_mend_is_registered_no_more_and_kept(registry, tmp_path):
    registry.note("cabinet-1", tags=("mine",))
    (registry.assets / "cabinet-1" / "meshes" / "a.obj").write_text("other")
    (registry.rejected / "chest-1" / "report.json").write_text("{")
    settled = mended(registry)
    assert settled == {"cabinet-1": Settled.WITHDRAWN, "chest-1": Settled.WITHDRAWN}
    assert [entry.id for entry in registry.walk()] == ["fridge-1"]
    assert verify(registry) == ()
    kept = registry.root / "withdrawn" / "cabinet-1"
    assert (kept / "meshes" / "a.obj").read_text() == "other"
    assert find_inputs((tmp_path,)) == ()
    # Its tags are there again once it is.
    publish(registry)
    assert registry.entry("cabinet-1").tags == ("mine",)


def test_what_there_was_no_time_for_stays(registry):
    (registry.assets / "cabinet-1" / "asset.urdf").unlink()
    assert mended(registry, final=False) == {"cabinet-1": Settled.LEFT}
    assert registry.find("cabinet-1") is not None


@pytest.mark.parametrize("step", ["delete", "rename"])
def test_a_process_that_dies_withdrawing_is_finished_by_the_next(registry, monkeypatch, step):
    (registry.assets / "cabinet-1" / "asset.urdf").unlink()
    where = verify_module.rows if step == "delete" else verify_module.os

    def dies(*asked):
        raise KeyboardInterrupt

    with monkeypatch.context() as dying:
        dying.setattr(where, step, dies)
        with pytest.raises(KeyboardInterrupt):
            set_asset_aside(registry, "cabinet-1", WITHDRAWN)
    assert mended(registry) == {"cabinet-1": Settled.WITHDRAWN}
    assert verify(registry) == ()
