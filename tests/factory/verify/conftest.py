"""Builds of one object after another, each told something else by a patch."""

import pytest

from asset_factory.factory.runtime.layout import CACHE


@pytest.fixture
def output(tmp_path, kept):
    """A folder for builds, whose stages are made once for all tests of a file."""
    (tmp_path / CACHE).symlink_to(kept)
    return tmp_path
