"""Filters, pages, counts, keys and notes.

Counts are kept, whoever writes; they are what counting the rows gives.
"""

import json
from dataclasses import replace
from itertools import product

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from registry_samples import BAD_REPORT, PASSED, REJECTED, named, publish

from asset_factory.factory.cli.commands import run as run_command
from asset_factory.factory.errors import RegistryError
from asset_factory.factory.registry import Registry, split_of
from asset_factory.factory.registry.database import connected, writing
from asset_factory.factory.registry.rebuild import new_database, rebuild
from asset_factory.factory.registry.report_file import BuildReport
from asset_factory.factory.registry.rows import RegistryRow, count, delete, having, insert, select
from asset_factory.sim_checks import Finding, Report, Severity


@pytest.fixture
def registry(tmp_path):
    made = Registry(tmp_path / "out", create=True)
    publish(made, entry=named("cabinet-1"))
    publish(made, entry=named("cabinet-2", key="cd" * 32, license="MIT"))
    publish(made, entry=named("fridge-1", category="fridge", key=""))
    made.add(replace(REJECTED, id="fridge-2", category="fridge", key=""), BAD_REPORT)
    return made


def ids(entries):
    return [entry.id for entry in entries]


@pytest.mark.parametrize(
    ("filters", "expected"),
    [
        ({}, ["cabinet-1", "cabinet-2", "fridge-1", "fridge-2"]),
        ({"status": "passed"}, ["cabinet-1", "cabinet-2", "fridge-1"]),
        ({"category": "fridge"}, ["fridge-1", "fridge-2"]),
        ({"category": "fridge", "status": "passed"}, ["fridge-1"]),
        ({"reason": "rest_penetration"}, ["fridge-2"]),
        ({"license": "MIT"}, ["cabinet-2"]),
        ({"tag": "blue"}, ["cabinet-2", "fridge-2"]),
        ({"tag": "blue", "status": "passed"}, ["cabinet-2"]),
        ({"solved": "yes"}, ["cabinet-2"]),
        ({"solved": "yes", "tag": "blue", "after": "cabinet-2"}, []),
        ({"limit": 2}, ["cabinet-1", "cabinet-2"]),
        ({"limit": 2, "after": "cabinet-2"}, ["fridge-1", "fridge-2"]),
        ({"tag": "blue", "after": "cabinet-2"}, ["fridge-2"]),
        ({"category": "'; DROP TABLE assets --"}, []),
    ],
)
def test_filters(registry, filters, expected):
    registry.note("cabinet-2", tags=("blue", "tall"), solved="yes")
    registry.note("fridge-2", tags=("blue",))
    assert ids(registry.entries(**filters)) == expected


@pytest.mark.parametrize("code", ["many_hulls", "many_hull_vertices", "oblong_hull"])
def test_what_physx_does_not_take_on_a_gpu_is_filtered_out(registry, code, capsys):
    beyond = Finding(code, Severity.WARNING, "beyond what a GPU takes", value=65.0, limit=64.0)
    harmless = Finding("collision_gap", Severity.WARNING, "a gap", value=12.0, limit=10.0)
    for asset_id, finding in (("shelf-1", beyond), ("shelf-2", harmless)):
        told = BuildReport(Report("asset.urdf", findings=(finding,)))
        publish(registry, entry=named(asset_id), report=told)
    ready = ["cabinet-1", "cabinet-2", "fridge-1", "shelf-2"]
    for _ in range(2):
        assert ids(registry.entries(gpu_ready="yes")) == ready
        assert ids(registry.entries(gpu_ready="no")) == ["shelf-1"]
        # Of what did not pass nothing is said.
        assert ids(registry.entries(gpu_ready="")) == ["fridge-2"]
        rebuild(registry.root)
    ask = ["list", "--output", str(registry.root), "--where", "gpu_ready = yes", "--json"]
    assert run_command(ask) == 0
    assert [row["id"] for row in json.loads(capsys.readouterr().out)] == ready


def test_the_split_follows_from_the_id(registry):
    for split in ("train", "test"):
        wanted = [each for each in ids(registry.walk()) if split_of(each) == split]
        assert ids(registry.entries(split=split)) == wanted
    assert replace(PASSED, id="other").split == split_of("other")


def test_walking_goes_through_all_pages(registry, monkeypatch):
    monkeypatch.setattr("asset_factory.factory.registry.registry._PAGE", 2)
    assert tuple(registry.walk()) == registry.entries()
    assert registry.count() == 4


def test_a_key_is_known_while_its_files_are_there(registry):
    known = "cd" * 32
    assert registry.known_keys((known, "ef" * 32, "")) == {known: registry.entry("cabinet-2")}
    (registry.assets / "cabinet-2" / "report.json").unlink()
    assert registry.known_keys((known,)) == {}


def test_notes_are_kept_and_taken_back(registry):
    assert registry.note("cabinet-1", tags=("b", "a", "b"), solved="no").tags == ("a", "b")
    assert registry.note("cabinet-1", solved="yes").tags == ("a", "b")
    assert registry.entry("cabinet-1").solved == "yes"
    assert (registry.root / "notes" / "cabinet-1.json").is_file()
    assert registry.note("cabinet-1", tags=(), solved="") == named("cabinet-1")
    assert not (registry.root / "notes" / "cabinet-1.json").exists()


def test_other_files_have_not_been_solved(registry):
    registry.note("cabinet-1", tags=("kept",), solved="yes")
    publish(registry, "one", entry=named("cabinet-1", key="ef" * 32))
    assert registry.entry("cabinet-1").solved == "yes"
    publish(registry, "two", entry=named("cabinet-1"))
    assert registry.entry("cabinet-1").solved == ""
    assert registry.entry("cabinet-1").tags == ("kept",)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"tags": ("two words",)}, "tag 'two words'"),
        ({"tags": ("../up",)}, "tag '../up'"),
        ({"solved": "perhaps"}, "solved must be one of '', 'yes', 'no', not 'perhaps'"),
    ],
)
def test_a_note_that_cannot_be_is_refused(registry, arguments, message):
    with pytest.raises(RegistryError, match=message):
        registry.note("cabinet-1", **arguments)


@pytest.mark.parametrize(
    ("asked", "told"),
    [
        ("cabnet-2", "did you mean.*cabinet-2"),
        ("fridge-1x", "did you mean.*fridge-1"),
        ("fridge", "did you mean.*fridge-1, fridge-2"),
        ("oven", "shows all 4"),
    ],
)
def test_ids_that_are_nearly_right_are_guessed_and_of_others_it_is_said_how_many_there_are(
    registry, asked, told
):
    with pytest.raises(RegistryError, match=told):
        registry.entry(asked)


STATUSES = ("passed", "rejected")
LICENSES = ("", "MIT")
SOLVED = ("", "yes")

entries = st.builds(
    replace,
    st.just(PASSED),
    id=st.integers(0, 5).map("thing-{}".format),
    status=st.sampled_from(STATUSES),
    license=st.sampled_from(LICENSES),
    solved=st.sampled_from(SOLVED),
)
#: Rows that are written, and ids that are dropped.
changes = st.lists(st.one_of(entries, st.integers(0, 5)), max_size=30)


def require_true_counts(connection):
    wanted = product((None, *STATUSES), (None, *LICENSES), (None, *SOLVED), (None, "train"))
    for status, license, solved, split in wanted:
        filters = having(status=status, license=license, solved=solved, split=split)
        rows = select(connection, filters, limit=None, after="")
        assert count(connection, filters) == len(rows), filters
    assert connection.execute("SELECT count(*) FROM counts WHERE number < 1").fetchone() == (0,)


@settings(max_examples=40, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(changes)
def test_counts_are_true_after_any_changes(registry, made):
    with connected(registry.root) as connection:
        connection.execute("BEGIN")
        for change in made:
            if isinstance(change, int):
                delete(connection, f"thing-{change}")
            else:
                insert(connection, RegistryRow(change, ""))
        require_true_counts(connection)
        connection.execute("ROLLBACK")


def test_a_database_written_at_once_counts_too_and_what_is_undone_is(tmp_path):
    registry = Registry(tmp_path / "out", create=True)
    (tmp_path / "new").mkdir()
    with new_database(tmp_path / "new" / "registry.db") as connection:
        for number in range(7):
            insert(connection, RegistryRow(replace(PASSED, id=f"thing-{number}"), ""))
    (tmp_path / "new" / "registry.db").replace(registry.root / "registry.db")
    assert registry.count() == 7
    with writing(registry.root) as connection:
        delete(connection, "thing-3")
        connection.execute("ROLLBACK")
        connection.execute("BEGIN")
    assert registry.count() == 7


def test_counting_reads_no_row(registry):
    with connected(registry.root) as connection:
        asked = []
        connection.set_trace_callback(asked.append)
        count(connection, having(category="fridge", status="passed"))
        plan = connection.execute(f"EXPLAIN QUERY PLAN {asked[0]}").fetchall()
    assert all("assets" not in str(step) for step in plan)
