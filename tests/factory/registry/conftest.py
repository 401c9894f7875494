"""The order of things is tested here, not what a disk keeps when the power fails, which takes long to wait for."""

from __future__ import annotations

import pytest


@pytest.fixture(autouse=True)
def unsynced(monkeypatch):
    monkeypatch.setattr("os.fsync", lambda descriptor: None)
