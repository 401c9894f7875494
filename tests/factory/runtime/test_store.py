"""The cache returns what was kept, and nothing for anything else."""

import json
import os
from unittest.mock import Mock

import numpy as np
import pytest

from asset_factory.factory.config import DecomposeConfig
from asset_factory.factory.runtime.store import (
    NOT_A_FILE,
    Store,
    digest_bytes,
    folder_digests,
    stage_key,
    write_json,
    write_whole,
)


def test_what_was_saved_is_loaded_packed_and_equal_arrays_are_kept_once(tmp_path):
    noise = np.random.default_rng(0).random(20_000)
    arrays = {"a": noise, "b": noise.copy(), "c": noise[::-1], "flat": np.zeros(100_000)}
    arrays["table"] = np.arange(6.0).reshape(2, 3)
    store = Store(tmp_path / "cache")
    assert store.load("stage-0") is None
    store.save("stage-0", arrays)
    loaded = store.load("stage-0")
    assert set(loaded) == set(arrays)
    for name, array in arrays.items():
        np.testing.assert_array_equal(loaded[name], array)
        assert loaded[name].dtype == array.dtype
    size = store.size()
    assert size.files == 1
    assert size.bytes < 2.1 * noise.nbytes
    (file,) = (tmp_path / "cache").rglob("*.npz")
    before = file.read_bytes()
    store.save("stage-0", arrays)
    assert file.read_bytes() == before


@pytest.mark.parametrize("damage", [b"", b"PK\x03\x04", b"not an archive"])
def test_a_damaged_file_is_a_miss(tmp_path, damage):
    store = Store(tmp_path)
    key = stage_key("decompose", 1)
    store.save(key, {"a": np.arange(3)})
    next(tmp_path.rglob("*.npz")).write_bytes(damage)
    assert store.load(key) is None


def test_every_input_counts():
    base = ("decompose", 1, np.arange(3.0), DecomposeConfig(), "1.0.14")
    others = (
        *((0, "trim"), (1, 2), (3, DecomposeConfig(seed=1)), (4, "1.0.15")),
        *((2, np.arange(3)), (2, np.arange(3.0).reshape(3, 1))),
    )
    keys = {stage_key(*base[:place], other, *base[place + 1 :]) for place, other in others}
    assert len(keys | {stage_key(*base)}) == 7
    assert stage_key(*base) == stage_key(*base[:2], np.arange(3.0), DecomposeConfig(), "1.0.14")


def test_what_is_written_is_there_for_all_and_what_cannot_be_leaves_nothing(tmp_path, monkeypatch):
    write_json(tmp_path / "a", {"b": 1}, lasting=True)
    assert json.loads((tmp_path / "a").read_text()) == {"b": 1}
    # Others may read it.
    assert (tmp_path / "a").stat().st_mode & 0o777 == 0o644
    write_whole(tmp_path / "a", b"old")
    monkeypatch.setattr("os.replace", Mock(side_effect=OSError(28, "No space left on device")))
    with pytest.raises(OSError, match="No space left"):
        write_whole(tmp_path / "a", b"new", lasting=True)
    monkeypatch.undo()
    with pytest.raises(ValueError, match="not JSON compliant"):
        write_json(tmp_path / "a", float("nan"))
    assert [path.name for path in tmp_path.iterdir()] == ["a"]
    assert (tmp_path / "a").read_bytes() == b"old"


def test_what_is_to_last_is_on_the_disk_before_and_after_it_gets_its_name(tmp_path, monkeypatch):
    done = []
    sync = os.fsync
    put = os.replace

    def noted_sync(descriptor):
        sync(descriptor)
        done.append(("synced", os.readlink(f"/proc/self/fd/{descriptor}")))

    def noted_replace(source, target):
        put(source, target)
        done.append(("named", source))

    monkeypatch.setattr("os.fsync", noted_sync)
    monkeypatch.setattr("os.replace", noted_replace)
    write_whole(tmp_path / "a", b"noted", lasting=True)
    temporary = done[0][1]
    assert done == [("synced", temporary), ("named", temporary), ("synced", str(tmp_path))]


def test_digests_of_a_folder(tmp_path):
    (tmp_path / "b").mkdir()
    (tmp_path / "b" / "c").write_bytes(b"1")
    (tmp_path / "a").write_bytes(b"")
    (tmp_path / "link").symlink_to("a")
    (tmp_path / "far").symlink_to("/etc")
    found = folder_digests(tmp_path, without=("a",))
    assert found == {"b/c": digest_bytes(b"1"), "far": NOT_A_FILE, "link": NOT_A_FILE}
    assert list(found) == sorted(found)
