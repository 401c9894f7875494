"""Every file that is not as it was published is named, and what can be mended without an input is.

Rows are made anew, additions moved aside, lost assets withdrawn.
"""

import shutil
from dataclasses import replace
from unittest.mock import Mock

import pytest
from registry_samples import alter, link, publish, remove

from asset_factory.factory.intake.discover import find_inputs
from asset_factory.factory.registry import verify as verify_module
from asset_factory.factory.registry.aside import set_asset_aside
from asset_factory.factory.registry.database import writing
from asset_factory.factory.registry.rows import RegistryRow, delete, insert
from asset_factory.factory.registry.verify import Settled, mend_rows, settle, verify
from asset_factory.factory.runtime.layout import WITHDRAWN
from asset_factory.factory.runtime.store import folder_digests


def add(folder):
    (folder / "meshes" / "b.obj").write_text("")


def alter_report(folder):
    report = folder / "report.json"
    report.write_text(report.read_text().replace('"passed": true', '"passed":  true'))


def spoil_report(folder):
    (folder / "report.json").write_text("{")


def mended(registry, *, final=True):
    problems = verify(registry)
    mend_rows(registry, problems)
    return settle(registry, problems, final=final)


@pytest.mark.parametrize(
    ("damage", "kind", "path", "settled"),
    [
        (alter, "altered", "assets/cabinet-1/meshes/a.obj", Settled.WITHDRAWN),
        (remove, "missing", "assets/cabinet-1/meshes/a.obj", Settled.WITHDRAWN),
        (add, "extra", "assets/cabinet-1/meshes/b.obj", Settled.MENDED),
        (link, "altered", "assets/cabinet-1/meshes/a.obj", Settled.WITHDRAWN),
        (alter_report, "altered", "assets/cabinet-1/report.json", Settled.WITHDRAWN),
        (spoil_report, "unreadable", "assets/cabinet-1/report.json", Settled.WITHDRAWN),
        (shutil.rmtree, "lost", "assets/cabinet-1", Settled.WITHDRAWN),
    ],
)
def test_damage_is_named_and_settled(registry, damage, kind, path, settled):
    assert verify(registry) == ()
    damage(registry.assets / "cabinet-1")
    problem = verify(registry)[0]
    assert (problem.id, problem.kind, problem.path) == ("cabinet-1", kind, path)
    assert verify(registry, ["fridge-1", "chest-1"]) == ()
    assert mended(registry) == {"cabinet-1": settled}
    assert (registry.find("cabinet-1") is None) == (settled is Settled.WITHDRAWN)
    assert verify(registry) == ()


def test_rows_and_folders_that_do_not_match_are_named_and_rows_made_anew(registry):
    before = registry.entries()
    with writing(registry.root) as connection:
        delete(connection, "cabinet-1")
        insert(connection, RegistryRow(replace(registry.entry("fridge-1"), hulls=99), ""))
    shutil.copytree(registry.rejected / "chest-1", registry.assets / "chest-1")
    kinds = {problem.id: problem.kind for problem in reversed(verify(registry))}
    assert kinds == {"cabinet-1": "unlisted", "chest-1": "twice", "fridge-1": "stale"}
    assert mended(registry) == dict.fromkeys(kinds, Settled.MENDED)
    assert registry.entries() == before


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
    alter(registry.assets / "cabinet-1")
    spoil_report(registry.rejected / "chest-1")
    lost = ("cabinet-1", "chest-1")
    # Not before everything was tried.
    assert mended(registry, final=False) == dict.fromkeys(lost, Settled.LEFT)
    assert len(registry.entries()) == 3
    assert mended(registry) == dict.fromkeys(lost, Settled.WITHDRAWN)
    assert [entry.id for entry in registry.walk()] == ["fridge-1"]
    kept = registry.root / "withdrawn" / "cabinet-1"
    assert (kept / "meshes" / "a.obj").read_text() == "1"
    assert find_inputs((tmp_path,)) == ()
    # Its tags are there again once it is.
    publish(registry)
    assert registry.entry("cabinet-1").tags == ("mine",)


@pytest.mark.parametrize("step", ["delete", "rename"])
def test_a_process_that_dies_withdrawing_is_finished_by_the_next(registry, monkeypatch, step):
    remove(registry.assets / "cabinet-1")
    where = verify_module.rows if step == "delete" else verify_module.os
    with monkeypatch.context() as dying:
        dying.setattr(where, step, Mock(side_effect=KeyboardInterrupt))
        with pytest.raises(KeyboardInterrupt):
            set_asset_aside(registry, "cabinet-1", WITHDRAWN)
    assert mended(registry) == {"cabinet-1": Settled.WITHDRAWN}
    assert verify(registry) == ()
