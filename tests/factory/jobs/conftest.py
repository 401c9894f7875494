"""Builds in the process of a test: how they are done, and that they leave nothing."""

import pytest

from asset_factory.factory.jobs import job as job_module
from asset_factory.factory.jobs import worker


@pytest.fixture(autouse=True)
def _judges_end():
    yield
    worker.close_judges()


@pytest.fixture
def builds_are(monkeypatch):
    """Lets a function stand for a build."""

    def replace_by(function):
        monkeypatch.setattr(job_module, "build_here", function)

    return replace_by
