"""What lies on disk: the table, the journal, names of nights, the lock."""

import subprocess
import sys

import pytest
from nights_made import attempt, night

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.jobs.nightly.attempt import tries
from asset_factory.factory.jobs.nightly.folder import (
    JOURNAL,
    SUMMARY,
    chosen_name,
    next_name,
    stored_nights,
    unfinished,
)
from asset_factory.factory.jobs.nightly.journal import journal, read_journal
from asset_factory.factory.jobs.nightly.lock import held
from asset_factory.factory.jobs.nightly.log import log
from asset_factory.factory.jobs.nightly.morning import Morning, summary_data
from asset_factory.factory.jobs.nightly.table import read_table, write_table
from asset_factory.factory.runtime.store import write_json

ATTEMPTS = (
    attempt(
        "a",
        seconds=12.345,
        stages={"load": 0.1, "validate": 2.0},
        parts=3,
        joints=2,
        hulls=40,
        licence="CC0-1.0",
    ),
    attempt("b", "rejected", stages={"load": 0.2}, key="ab" * 32, started="2026-11-21T01:00:00Z"),
    attempt("c", attempts=0, reused=("build",)),
    attempt("ü\n\"',", "unjudged", attempts=2, reused=("decompose", "articulate")),
)


def test_the_table_read_back_is_the_rows(tmp_path):
    pytest.importorskip("pyarrow")
    write_table(tmp_path / "attempts.parquet", tries(ATTEMPTS))
    assert read_table(tmp_path / "attempts.parquet") == ATTEMPTS
    write_table(tmp_path / "attempts.parquet", ())
    assert read_table(tmp_path / "attempts.parquet") == ()
    assert [path.name for path in tmp_path.iterdir()] == ["attempts.parquet"]


def test_the_table_has_a_column_per_stage_and_types_for_others_to_use(tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    write_table(tmp_path / "attempts.parquet", tries(ATTEMPTS))
    table = parquet.read_table(tmp_path / "attempts.parquet")
    assert table.column("seconds_validate").to_pylist() == [2.0, None, None, None, None]
    assert table.column_names[-2:] == ["seconds_load", "seconds_validate"]
    assert str(table.schema.field("hulls").type) == "int32"


def test_the_table_has_a_row_per_attempt_and_says_which_counts(tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    first, again = attempt("a", "unjudged", key="1"), attempt("a", key="2", attempts=3, seconds=2.0)
    known = attempt("a", key="2", attempts=0)
    write_table(
        tmp_path / "attempts.parquet", tries((first, again, attempt("b", attempts=0), known))
    )
    columns = parquet.read_table(tmp_path / "attempts.parquet").to_pydict()
    assert columns["attempt"] == [1, 1, 2, 3, 0]
    assert columns["last"] == [False, False, False, True, True]
    assert columns["status"] == ["unjudged", "unjudged", "unjudged", "passed", "passed"]
    assert columns["reason"] == ["build_crashed", "tried_again", "tried_again", "", ""]
    assert columns["seconds"] == [0.0, None, None, 2.0, 0.0]
    assert [row.input for row in read_table(tmp_path / "attempts.parquet")] == [
        "meshes/a.glb",
        "meshes/b.glb",
    ]


def test_a_table_that_is_damaged_is_none(tmp_path):
    pytest.importorskip("pyarrow")
    (tmp_path / "attempts.parquet").write_bytes(b"PAR1 no")
    assert read_table(tmp_path / "attempts.parquet") == ()
    assert read_table(tmp_path / "nowhere.parquet") == ()


def test_the_journal_survives_being_cut_at_any_byte(tmp_path):
    path = tmp_path / "attempts.jsonl"
    with journal(path) as book:
        for row in ATTEMPTS:
            book.add(row)
    assert read_journal(path) == ATTEMPTS
    whole = path.read_bytes()
    for cut in range(0, len(whole), 37):
        path.write_bytes(whole[:cut])
        with journal(path) as book:
            book.add(ATTEMPTS[0])
        rows = read_journal(path)
        complete = whole[:cut].count(b"\n")
        assert rows[:complete] == ATTEMPTS[:complete]
        assert rows[-1] == ATTEMPTS[0]
        assert len(rows) - complete in (1, 2)


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
    for name in ("0001", "0002"):
        (tmp_path / name).mkdir()
    (tmp_path / "0002" / JOURNAL).touch()
    assert unfinished(tmp_path) == ("0002",)
    assert chosen_name(tmp_path, None) == "0002"
    assert chosen_name(tmp_path, "0002") == "0002"


def test_summaries_are_read_in_the_order_of_the_nights(tmp_path):
    for name, started in (("later", "2026-11-20T01:00:00Z"), ("sooner", "2026-11-19T01:00:00Z")):
        (tmp_path / name).mkdir()
        write_json(
            tmp_path / name / SUMMARY,
            summary_data(Morning(night(name, [attempt("a")], started=started))),
        )
    for name, text in (
        ("broken", "{"),
        ("strange", '{"night": {"name": "x", "passed": "many"}}'),
        ("none", "[]"),
    ):
        (tmp_path / name).mkdir()
        (tmp_path / name / SUMMARY).write_text(text)
    (tmp_path / "empty").mkdir()
    assert [stored.name for stored in stored_nights(tmp_path)] == ["sooner", "later"]
    (tmp_path / "later").rename(tmp_path / "renamed")
    assert [stored.name for stored in stored_nights(tmp_path)] == ["sooner", "renamed"]


HOLDER = """
import sys
from pathlib import Path
from asset_factory.factory.jobs.nightly.lock import held
with held(Path(sys.argv[1])) as tell:
    tell("0007")
    print("held", flush=True)
    sys.stdin.read()
"""


def test_two_nights_on_one_output_do_not_run_at_once(tmp_path):
    with subprocess.Popen(
        [sys.executable, "-c", HOLDER, str(tmp_path)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    ) as other:
        assert other.stdout.readline() == "held\n"
        sentence = f"another night runs here .night 0007, process {other.pid} on .*wait"
        with pytest.raises(ConfigError, match=sentence), held(tmp_path):
            pass
        other.kill()
    with held(tmp_path) as tell:
        tell("0008")


def test_the_log_has_a_line_each_with_the_time(tmp_path):
    with log(tmp_path / "night.log") as write:
        write("one\ntwo")
        write("three")
    lines = (tmp_path / "night.log").read_text().splitlines()
    assert [line.split("Z ")[1] for line in lines] == ["one two", "three"]
