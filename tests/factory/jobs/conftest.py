"""What builds in the process of a test leave there is ended with it."""

import pytest

from asset_factory.factory.jobs import worker


@pytest.fixture(autouse=True)
def _judges_end():
    yield
    worker.close_judges()
