"""What tests of several folders share."""

import pytest

from asset_factory.sim_checks.judge import Judge


@pytest.fixture(scope="module")
def judge():
    """One judge for all files of a module: its children are started once."""
    with Judge() as judge:
        yield judge
