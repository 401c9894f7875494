"""The order of writes is tested, not what a disk keeps without power; so syncing is left out."""

import pytest
from registry_samples import three_entries


@pytest.fixture(autouse=True)
def unsynced(monkeypatch):
    monkeypatch.setattr("os.fsync", lambda descriptor: None)


@pytest.fixture
def registry(tmp_path):
    return three_entries(tmp_path / "out")
