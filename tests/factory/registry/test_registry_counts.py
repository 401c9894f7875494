"""Counts are kept, whoever writes; they are what counting the rows gives."""

from dataclasses import replace
from itertools import product

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from registry_samples import PASSED

from asset_factory.factory.registry import Registry
from asset_factory.factory.registry.database import connected, writing
from asset_factory.factory.registry.rebuild import new_database
from asset_factory.factory.registry.rows import RegistryRow, count, delete, having, insert, select

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


@pytest.fixture(scope="module")
def registry(tmp_path_factory):
    return Registry(tmp_path_factory.mktemp("counts") / "out", create=True)


@settings(max_examples=40, deadline=None)
@given(changes)
def test_counts_are_true_after_any_changes(registry, made):
    with connected(registry.root) as connection:
        connection.execute("BEGIN")
        for change in made:
            if isinstance(change, int):
                delete(connection, f"thing-{change}")
            else:
                insert(connection, (RegistryRow(change, ""),))
        require_true_counts(connection)
        connection.execute("ROLLBACK")


def test_a_database_written_at_once_counts_too_and_what_is_undone_is(tmp_path):
    found = [RegistryRow(replace(PASSED, id=f"thing-{number}"), "") for number in range(7)]
    registry = Registry(tmp_path / "out", create=True)
    (tmp_path / "new").mkdir()
    with new_database(tmp_path / "new" / "registry.db") as connection:
        insert(connection, found)
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
