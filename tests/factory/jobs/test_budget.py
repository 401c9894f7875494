"""Points in time."""

import os

import pytest

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.jobs.budget import modified_since, parse_since


def test_a_point_in_time_is_seconds_ago_a_date_or_a_file(tmp_path):
    assert parse_since("3600", now=10_000.0) == 6_400.0
    assert parse_since("2026-11-21T00:00+00:00") == 1_795_219_200.0
    assert parse_since("2026-11-21T01:00+01:00") == 1_795_219_200.0
    stamp = tmp_path / "stamp"
    stamp.touch()
    os.utime(stamp, (500.0, 500.0))
    assert parse_since(str(stamp)) == 500.0
    for text in ("yesterday", "-1", "nan", str(tmp_path / "nothing")):
        with pytest.raises(ConfigError, match="must be seconds ago, a date such as"):
            parse_since(text)


def test_only_what_was_modified_since_is_wanted(tmp_path):
    for name, modified in (("old", 100.0), ("new", 300.0)):
        (tmp_path / name).touch()
        os.utime(tmp_path / name, (modified, modified))
    paths = (tmp_path / "old", tmp_path / "new", tmp_path / "gone")
    assert list(modified_since(paths, 200.0)) == [tmp_path / "new", tmp_path / "gone"]
