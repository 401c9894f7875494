"""What a night writes while it runs: the journal, the lock, the log."""

import subprocess
import sys
from datetime import UTC, datetime

import pytest
from nights_made import ATTEMPTS

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.jobs.nightly.journal import journal, locked, log, read_journal


def test_the_journal_survives_being_cut_at_any_byte(tmp_path):
    path = tmp_path / "attempts.jsonl"
    with journal(path) as add:
        for row in ATTEMPTS:
            add(row)
    assert read_journal(path) == ATTEMPTS
    whole = path.read_bytes()
    for cut in range(0, len(whole), 37):
        path.write_bytes(whole[:cut])
        with journal(path) as add:
            add(ATTEMPTS[0])
        rows = read_journal(path)
        complete = whole[:cut].count(b"\n")
        assert rows[:complete] == ATTEMPTS[:complete]
        assert rows[-1] == ATTEMPTS[0]
        assert len(rows) - complete in (1, 2)


HOLDER = """
import sys
from pathlib import Path
from asset_factory.factory.jobs.nightly.journal import locked
with locked(Path(sys.argv[1])) as announce:
    announce("0007")
    print("held", flush=True)
    sys.stdin.read()
"""


def test_two_nights_on_one_output_do_not_run_at_once(tmp_path):
    command = [sys.executable, "-c", HOLDER, str(tmp_path)]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    with subprocess.Popen(command, **pipes, text=True) as other:
        assert other.stdout.readline() == "held\n"
        sentence = f"another night runs here .night 0007, process {other.pid} on .*wait"
        with pytest.raises(ConfigError, match=sentence), locked(tmp_path):
            pass
        other.kill()
    with locked(tmp_path) as announce:
        announce("0008")


def test_the_log_has_a_line_each_with_the_time(tmp_path):
    with log(tmp_path / "night.log", lambda: datetime(2026, 11, 21, 1, tzinfo=UTC)) as write:
        write("one\ntwo")
        write("three")
    told = (tmp_path / "night.log").read_text()
    assert told == "2026-11-21T01:00:00Z one two\n2026-11-21T01:00:00Z three\n"
