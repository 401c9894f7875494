"""What tests of several folders share."""

import pytest

from asset_factory.sim_checks.judge import Judge


@pytest.fixture(scope="session")
def judge():
    """One judge for all files: its children are started once."""
    with Judge() as judge:
        yield judge
