"""What a night leaves on disk: the table, the summary, and the names of nights."""

import pytest
from laid import laid
from nights_made import ATTEMPTS, attempt, night
from pyarrow import parquet  # noqa: TID253

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.report.nightly.files import (
    JOURNAL,
    SUMMARY,
    chosen_name,
    next_name,
    read_sources,
    stored_nights,
    unfinished,
)
from asset_factory.factory.report.nightly.report import NightlyReport, summary
from asset_factory.factory.report.nightly.table import read_table, write_table
from asset_factory.factory.runtime.store import write_json


def test_the_table_read_back_is_the_rows_with_columns_for_others_to_use(tmp_path):
    path = tmp_path / "attempts.parquet"
    assert read_table(path) == ()
    write_table(path, ATTEMPTS)
    assert read_table(path) == ATTEMPTS
    table = parquet.read_table(path)
    assert table.column("seconds_validate").to_pylist() == [2.0, None, None, None, None]
    assert table.column_names[-2:] == ["seconds_load", "seconds_validate"]
    assert str(table.schema.field("hulls").type) == "int32"
    write_table(path, ())
    assert read_table(path) == ()
    assert list(tmp_path.iterdir()) == [path]
    path.write_bytes(b"PAR1 no")
    assert read_table(path) == ()


def test_the_table_has_a_row_per_attempt_and_says_which_counts(tmp_path):
    first = attempt("a", "unjudged", key="1")
    again = attempt("a", key="2", attempts=3, seconds=2.0)
    known = attempt("a", key="2", attempts=0)
    write_table(tmp_path / "attempts.parquet", (first, again, attempt("b", attempts=0), known))
    columns = parquet.read_table(tmp_path / "attempts.parquet").to_pydict()
    assert columns["attempt"] == [1, 1, 2, 3, 0]
    assert columns["last"] == [False, False, False, True, True]
    assert columns["status"] == ["unjudged", "unjudged", "unjudged", "passed", "passed"]
    assert columns["reason"] == ["build_crashed", "tried_again", "tried_again", "", ""]
    assert columns["seconds"] == [0.0, None, None, 2.0, 0.0]
    inputs = [row.input for row in read_table(tmp_path / "attempts.parquet")]
    assert inputs == ["meshes/a.glb", "meshes/b.glb"]


def test_nights_are_numbered_and_named(tmp_path):
    assert next_name(tmp_path) == "0001"
    for name in ("0001", "0009", "before-upgrade", ".hidden"):
        (tmp_path / name).mkdir()
    assert next_name(tmp_path) == "0010"
    assert chosen_name(tmp_path, None) == "0010"
    assert chosen_name(tmp_path, "after-upgrade") == "after-upgrade"
    with pytest.raises(ConfigError, match="is finished"):
        chosen_name(tmp_path, "before-upgrade")
    for wrong in ("../x", "", ".x", "a b", "x" * 65, "a/b"):
        with pytest.raises(ConfigError, match="--name"):
            chosen_name(tmp_path, wrong)


def test_a_night_that_was_interrupted_goes_on(tmp_path):
    (tmp_path / "0001").mkdir()
    laid(tmp_path / "0002" / JOURNAL)
    assert unfinished(tmp_path) == ("0002",)
    assert chosen_name(tmp_path, None) == "0002"
    assert chosen_name(tmp_path, "0002") == "0002"


def test_summaries_are_read_in_the_order_of_the_nights(tmp_path):
    for name, started in (("later", "2026-11-20T01:00:00Z"), ("sooner", "2026-11-19T01:00:00Z")):
        (tmp_path / name).mkdir()
        report = NightlyReport(night(name, [attempt("a")], started=started))
        write_json(tmp_path / name / SUMMARY, summary(report))
    for name, text in (
        ("broken", "{"),
        ("strange", '{"night": {"name": "x", "passed": "many"}}'),
        ("none", "[]"),
    ):
        laid(tmp_path / name / SUMMARY, text)
    (tmp_path / "empty").mkdir()
    assert [stored.name for stored in stored_nights(tmp_path)] == ["sooner", "later"]
    (tmp_path / "later").rename(tmp_path / "renamed")
    assert [stored.name for stored in stored_nights(tmp_path)] == ["sooner", "renamed"]


@pytest.mark.parametrize("data", [{}, {"sources": 3}, {"sources": [{"source": "a"}]}])
def test_summaries_of_other_versions_tell_nothing_of_sources(tmp_path, data):
    write_json(tmp_path / SUMMARY, data)
    assert read_sources(tmp_path) == {}
