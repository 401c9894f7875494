"""The folders are the truth: the database comes back from them, and from older ones."""

import os
import shutil
import sqlite3
from contextlib import closing

import pytest
from registry_samples import BAD_REPORT, REJECTED, dump

from asset_factory.factory.errors import RegistryError
from asset_factory.factory.registry import Registry
from asset_factory.factory.registry.database import SCHEMA_VERSION
from asset_factory.factory.registry.rebuild import rebuild
from asset_factory.factory.registry.verify import verify


def lose(registry, how):
    database = registry.root / "registry.db"
    if how == "deleted":
        return database.unlink()
    whole = database.read_bytes()
    contents = {"intact": whole, "garbage": b"no database at all" * 1000, "empty": b""}
    contents["torn"] = whole[:4096] + b"\xff" * (len(whole) - 4096)
    return database.write_bytes(contents[how])


@pytest.mark.parametrize("how", ["intact", "deleted", "garbage", "empty", "torn"])
def test_rows_come_back_byte_for_byte(registry, how):
    before = dump(registry)
    lose(registry, how)
    assert rebuild(registry.root) == []
    assert dump(Registry(registry.root)) == before
    assert registry.entry("fridge-1").tags == ("blue",)
    assert verify(registry) == ()
    # A build into folders without a database loses none of them either.
    lose(registry, "deleted")
    assert dump(Registry(registry.root, create=True)) == before


@pytest.mark.parametrize(
    ("how", "message"),
    [*((how, "damaged") for how in ("garbage", "torn", "empty")), ("deleted", "no registry.db")],
)
def test_a_lost_database_says_what_brings_it_back(registry, how, message):
    lose(registry, how)
    remedy = f"`factory registry rebuild --output {registry.root}`"
    with pytest.raises(RegistryError, match=f"{message}.*{remedy}"):
        Registry(registry.root).entries()


def test_rows_without_a_folder_go_and_folders_without_a_row_come(registry):
    shutil.rmtree(registry.assets / "cabinet-1")
    shutil.copytree(registry.assets / "fridge-1", registry.assets / "fridge-2")
    (unreadable,) = rebuild(registry.root)
    assert "fridge-2" in unreadable
    assert "is of 'fridge-1'" in unreadable
    assert [entry.id for entry in registry.entries()] == ["chest-1", "fridge-1"]


@pytest.mark.parametrize("newer", ["assets", "rejected"])
def test_of_an_asset_in_two_places_the_newer_counts_and_the_other_goes(registry, newer):
    shutil.copytree(registry.assets / "cabinet-1", registry.root / "kept")
    registry.add(REJECTED, BAD_REPORT)
    shutil.move(registry.root / "kept", registry.assets / "cabinet-1")
    os.utime(registry.root / newer / "cabinet-1" / "report.json", (2.0e9, 2.0e9))
    assert rebuild(registry.root) == []
    assert registry.entry("cabinet-1").folder == f"{newer}/cabinet-1"
    assert verify(registry) == ()


@pytest.mark.parametrize(
    "content",
    ["", "{", "[]", '{"entry": 3}', '{"entry": {"id": 7}}', '{"entry": {}, "files": {"a": "b"}}'],
)
def test_a_report_that_is_none_is_named_and_left(registry, content):
    (registry.assets / "cabinet-1" / "report.json").write_text(content)
    (unreadable,) = rebuild(registry.root)
    assert "cabinet-1" in unreadable
    assert registry.count() == 2
    assert (registry.assets / "cabinet-1" / "meshes" / "a.obj").is_file()


def test_a_newer_database_is_left_alone(registry):
    with closing(sqlite3.connect(registry.root / "registry.db")) as connection:
        connection.execute(f"PRAGMA user_version = {SCHEMA_VERSION + 1}")
    told = f"version {SCHEMA_VERSION + 1}, this program knows up to {SCHEMA_VERSION}; use"
    for opening in (Registry, rebuild):
        with pytest.raises(RegistryError, match=told):
            opening(registry.root)


def test_an_older_database_is_made_anew_from_the_folders(registry):
    before = dump(registry)
    with closing(sqlite3.connect(registry.root / "registry.db")) as connection, connection:
        connection.execute("DROP TABLE tags")
        connection.execute(f"PRAGMA user_version = {SCHEMA_VERSION - 1}")
    assert dump(Registry(registry.root)) == before
    assert verify(registry) == ()
