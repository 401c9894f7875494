"""What tests of several folders share."""

import pytest
from s3_server import s3_server

from asset_factory.factory.models.weights import pickled
from asset_factory.sim_checks.processes.isolation import WarmChild


@pytest.fixture(scope="module")
def reading_child():
    with WarmChild() as child:
        yield child


@pytest.fixture(scope="module")
def kept(tmp_path_factory):
    """Where stages are kept for all tests of a file."""
    return tmp_path_factory.mktemp("kept")


@pytest.fixture(scope="module")
def server():
    with s3_server() as address:
        yield address


@pytest.fixture
def warm_reader(monkeypatch, reading_child):
    """What torch saved is read by one child: each would take seconds to import torch."""
    monkeypatch.setattr(pickled, "run_isolated", reading_child.call)
    # Hostile files are stopped by this limit, and made sure of in a second child.
    monkeypatch.setattr(pickled, "_READING_S", 1)
