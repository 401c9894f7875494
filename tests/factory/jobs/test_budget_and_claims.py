"""Points in time, limits that cannot be, and rights to work that end with whoever had them."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.jobs import Budget
from asset_factory.factory.jobs.budget import modified_since, parse_since
from asset_factory.factory.jobs.claims import claim


def test_a_point_in_time_is_seconds_ago_a_date_or_a_file(tmp_path) -> None:
    assert parse_since("3600", now=10_000.0) == 6_400.0
    assert parse_since("2026-11-21T00:00+00:00") == 1_795_219_200.0
    assert parse_since("2026-11-21T01:00+01:00") == 1_795_219_200.0
    stamp = tmp_path / "stamp"
    stamp.touch()
    os.utime(stamp, (500.0, 500.0))
    assert parse_since(str(stamp)) == 500.0
    for text in ("yesterday", "-1", "nan", str(tmp_path / "nothing")):
        with pytest.raises(ConfigError, match="want seconds ago, a date such as"):
            parse_since(text)


def test_only_what_was_modified_since_is_wanted(tmp_path) -> None:
    for name, modified in (("old", 100.0), ("new", 300.0)):
        (tmp_path / name).touch()
        os.utime(tmp_path / name, (modified, modified))
    paths = (tmp_path / "old", tmp_path / "new", tmp_path / "gone")
    assert list(modified_since(paths, 200.0)) == [tmp_path / "new", tmp_path / "gone"]


@pytest.mark.parametrize("wrong", [{"limit": -1}, {"max_s": -1.0}, {"max_s": float("nan")}])
def test_a_budget_that_cannot_be_is_refused(wrong) -> None:
    with pytest.raises(ConfigError, match="want 0 or more"):
        Budget(**wrong)


def test_a_claim_is_had_by_one_until_it_is_released(tmp_path) -> None:
    first = claim(tmp_path / "claims", "work")
    assert first is not None
    assert claim(tmp_path / "claims", "work") is None
    other = claim(tmp_path / "claims", "other")
    assert other is not None
    first.release()
    again = claim(tmp_path / "claims", "work")
    assert again is not None
    again.release()
    other.release()
    assert list((tmp_path / "claims").iterdir()) == []


def test_a_claim_ends_with_its_process(tmp_path) -> None:
    script = (
        "import sys, time; from pathlib import Path; from asset_factory.factory.jobs.claims import claim;"
        "held = claim(Path(sys.argv[1]), 'work'); print('held', flush=True); time.sleep(60)"
    )
    with subprocess.Popen([sys.executable, "-c", script, str(tmp_path)], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "held\n"
        assert claim(tmp_path, "work") is None
        process.kill()
        process.wait()
        mine = claim(tmp_path, "work")
    assert mine is not None
    mine.release()
    assert not Path(tmp_path / "work").exists()
