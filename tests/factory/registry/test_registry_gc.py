"""What nobody needs is removed, and nothing else; rights to work end with whoever had them."""

import multiprocessing
import os
import time

import numpy as np
import pytest

from asset_factory.factory.registry import Registry
from asset_factory.factory.registry.claims import claim
from asset_factory.factory.registry.cleaning import collect_garbage
from asset_factory.factory.runtime.store import Store, stage_key, write_whole

DAY = 86_400.0


def work(root, ready):
    held = claim(root / ".claims", "work")
    with Registry(root).staging_folder() as folder:
        (folder / "half.obj").write_text("x" * 1000)
        ready.send(held is not None)
        time.sleep(60)


@pytest.fixture
def worker(registry):
    context = multiprocessing.get_context("fork")
    ready, sender = context.Pipe()
    process = context.Process(target=work, args=(registry.root, sender))
    process.start()
    assert ready.poll(30)
    assert ready.recv()
    yield process
    process.kill()
    process.join(30)
    ready.close()
    sender.close()


def test_a_living_process_keeps_its_folder_and_claim_a_dead_one_does_not(registry, worker):
    claims = registry.root / ".claims"
    (claims / "left").touch()
    assert collect_garbage(registry.root).staging.files == 0
    assert len(list((registry.root / ".staging").glob("*/half.obj"))) == 1
    assert [path.name for path in claims.iterdir()] == ["work"]
    assert claim(claims, "work") is None
    worker.kill()
    worker.join(30)
    claim(claims, "work").close()
    freed = collect_garbage(registry.root)
    assert (freed.staging.files, freed.staging.bytes) == (1, 1000)
    assert list((registry.root / ".staging").iterdir()) == []
    assert registry.count() == 3


def test_a_claim_is_had_by_one_until_it_is_released(tmp_path):
    first = claim(tmp_path / "claims", "work")
    assert claim(tmp_path / "claims", "work") is None
    other = claim(tmp_path / "claims", "other")
    first.close()
    again = claim(tmp_path / "claims", "work")
    again.close()
    other.close()
    assert list((tmp_path / "claims").iterdir()) == []


def left(store, numbers=range(4)):
    """Which are still there of some, which are used by asking."""
    keys = {number: stage_key("decompose", 1, number) for number in numbers}
    return [number for number, key in keys.items() if store.load(key) is not None]


@pytest.mark.parametrize(
    ("ages", "days", "share", "used", "kept"),
    [
        ((0, 1, 10, 100), 5, None, (), [0, 1]),
        # Files from the future are not kept for ever.
        ((-400, 0.5), 30, None, (), [1]),
        # The longest unused first.
        ((0, 1, 10, 100), None, 0.5, (), [0, 1]),
        ((0, 1, 10, 100), 0, 0, (3,), [0, 3]),
    ],
    ids=["by age", "from the future", "by size", "just used"],
)
def test_the_cache_shrinks(registry, ages, days, share, used, kept):
    store = Store(registry.root / ".cache")
    for number, age in enumerate(ages):
        key = stage_key("decompose", 1, number)
        store.save(key, {"a": np.zeros(100)})
        path = store.root / key[-2:] / f"{key}.npz"
        os.utime(path, (time.time() - age * DAY,) * 2)
    assert left(store, used) == list(used)
    older_than_s = None if days is None else days * DAY
    keep_bytes = None if share is None else int(share * store.size().bytes)
    freed = collect_garbage(registry.root, older_than_s=older_than_s, keep_bytes=keep_bytes).cache
    assert freed.files == len(ages) - len(kept)
    assert left(store) == kept


@pytest.mark.parametrize("age", [-1, 0, 1])
def test_unfinished_files_go_when_nobody_writes_them_whatever_the_clock_says(
    registry, age, monkeypatch
):
    (registry.root / ".cache" / "ab").mkdir(parents=True)
    for folder in (".", ".cache/ab"):
        path = registry.root / folder / ".writing-dead"
        path.write_text("half")
        os.utime(path, (time.time() - age * DAY,) * 2)

    def meanwhile(number, mode):
        assert collect_garbage(registry.root).unfinished.files == 2
        assert [path.name for path in registry.root.rglob(".writing-*")] != []

    monkeypatch.setattr(os, "fchmod", meanwhile)
    write_whole(registry.root / "whole", b"content")
    assert (registry.root / "whole").read_bytes() == b"content"
