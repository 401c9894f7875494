"""What nobody needs is removed, and nothing else."""

import multiprocessing
import os
import time

import numpy as np
import pytest

from asset_factory.factory.registry import Registry
from asset_factory.factory.registry.cleaning import collect_garbage
from asset_factory.factory.runtime.store import Store, stage_key, write_whole

DAY = 86_400.0


def work(root, ready):
    with Registry(root).staging_folder() as folder:
        (folder / "half.obj").write_text("x" * 1000)
        ready.send(True)
        time.sleep(60)


@pytest.fixture
def worker(registry):
    context = multiprocessing.get_context("fork")
    ready, sender = context.Pipe()
    process = context.Process(target=work, args=(registry.root, sender))
    process.start()
    assert ready.poll(30)
    yield process
    process.kill()
    process.join(30)
    ready.close()
    sender.close()


def test_a_living_process_keeps_its_folder_a_dead_one_does_not(registry, worker):
    assert collect_garbage(registry.root).staging.files == 0
    assert len(list((registry.root / ".staging").glob("*/half.obj"))) == 1
    worker.kill()
    worker.join(30)
    freed = collect_garbage(registry.root)
    assert (freed.staging.files, freed.staging.bytes) == (1, 1000)
    assert list((registry.root / ".staging").iterdir()) == []
    assert registry.count() == 3


def cached(registry, ages):
    store = Store(registry.root / ".cache")
    for number, age in enumerate(ages):
        key = stage_key("decompose", 1, number)
        store.save(key, {"a": np.zeros(100)})
        path = store.root / key[-2:] / f"{key}.npz"
        os.utime(path, (time.time() - age * DAY,) * 2)
    return store


def left(store):
    return [
        number for number in range(4) if store.load(stage_key("decompose", 1, number)) is not None
    ]


@pytest.mark.parametrize(
    ("ages", "days", "kept"),
    # Files from the future are not kept for ever.
    [((0, 1, 10, 100), 5, [0, 1]), ((-400, 0.5), 30, [1])],
)
def test_the_cache_shrinks_by_age(registry, ages, days, kept):
    store = cached(registry, ages)
    freed = collect_garbage(registry.root, older_than_s=days * DAY).cache
    assert freed.files == len(ages) - len(kept)
    assert left(store) == kept


def test_the_cache_shrinks_by_size_longest_unused_first(registry):
    store = cached(registry, (0, 1, 10, 100))
    size = sum(path.stat().st_size for path in store.root.rglob("*.npz"))
    collect_garbage(registry.root, keep_bytes=size // 2)
    assert left(store) == [0, 1]


def test_what_was_just_used_stays(registry):
    store = cached(registry, (0, 1, 10, 100))
    assert store.load(stage_key("decompose", 1, 3)) is not None
    collect_garbage(registry.root, older_than_s=0.0, keep_bytes=0)
    assert left(store) == [0, 3]


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
