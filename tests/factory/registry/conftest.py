"""The order of writes is tested, not what a disk keeps without power; so syncing is left out."""

import pytest


@pytest.fixture(autouse=True)
def unsynced(monkeypatch):
    monkeypatch.setattr("os.fsync", lambda descriptor: None)
