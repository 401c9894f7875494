"""The cache returns what was kept, and nothing for anything else."""

import numpy as np
import pytest

from asset_factory.factory.config import DecomposeConfig
from asset_factory.factory.store import Store, stage_key


def test_what_was_saved_is_loaded(tmp_path):
    store, key = Store(tmp_path / "cache"), stage_key("decompose", 1, np.arange(3))
    assert store.load(key) is None
    store.save(key, {"a": np.arange(6.0).reshape(2, 3)})
    np.testing.assert_array_equal(store.load(key)["a"], np.arange(6.0).reshape(2, 3))


@pytest.mark.parametrize("damage", [b"", b"PK\x03\x04", b"not an archive"])
def test_a_damaged_file_is_a_miss(tmp_path, damage):
    store, key = Store(tmp_path), stage_key("decompose", 1)
    store.save(key, {"a": np.arange(3)})
    next(tmp_path.rglob("*.npz")).write_bytes(damage)
    assert store.load(key) is None


def test_every_input_counts():
    base = ("decompose", 1, np.arange(3.0), DecomposeConfig(), "1.0.14")
    keys = {
        stage_key(*base),
        stage_key("trim", *base[1:]),
        stage_key("decompose", 2, *base[2:]),
        stage_key("decompose", 1, np.arange(3), DecomposeConfig(), "1.0.14"),
        stage_key("decompose", 1, np.arange(3.0).reshape(3, 1), DecomposeConfig(), "1.0.14"),
        stage_key("decompose", 1, np.arange(3.0), DecomposeConfig(seed=1), "1.0.14"),
        stage_key("decompose", 1, np.arange(3.0), DecomposeConfig(), "1.0.15"),
    }
    assert len(keys) == 7
    assert stage_key(*base) == stage_key("decompose", 1, np.arange(3.0), DecomposeConfig(), "1.0.14")
