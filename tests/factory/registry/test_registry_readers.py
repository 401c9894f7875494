"""Whoever reads while others publish, exchange, rebuild and clean up finds whole assets."""

import multiprocessing
import time
from contextlib import contextmanager

from registry_samples import BAD_REPORT, REJECTED, named, publish

from asset_factory.factory.registry import Registry
from asset_factory.factory.registry.cleaning import collect_garbage
from asset_factory.factory.registry.rebuild import rebuild
from asset_factory.factory.registry.verify import verify

SECONDS = 1.5


def read(root, stop, answers):
    """Look at everything again and again; the first thing that is wrong ends it."""
    times = 0
    try:
        while not stop.is_set():
            registry = Registry(root)
            entries = registry.entries()
            assert [entry.id for entry in entries] == ["cabinet-1", "cabinet-2", "chest-1"], entries
            for entry in entries[:2]:
                assert (registry.folder(entry) / "meshes" / "a.obj").read_text() in ("one", "two")
                assert (registry.folder(entry) / "asset.urdf").is_file()
            for entry in entries:
                registry.told(entry)
            assert registry.entry("cabinet-1").status == "passed"
            times += 1
        answers.put(times)
    except BaseException as error:
        answers.put(f"{type(error).__name__}: {error}")
        raise


@contextmanager
def reader(root):
    context = multiprocessing.get_context("fork")
    stop = context.Event()
    answers = context.Queue()
    process = context.Process(target=read, args=(root, stop, answers))
    process.start()
    yield
    stop.set()
    times = answers.get(timeout=30)
    process.join(30)
    assert isinstance(times, int), times
    assert times >= 3


def test_readers_see_whole_assets_only(tmp_path):
    registry = Registry(tmp_path / "out", create=True)
    publish(registry, "one", named("cabinet-1"))
    publish(registry, "one", named("cabinet-2"))
    publish(registry, "one", named("chest-1"))
    end = time.monotonic() + SECONDS
    rounds = 0
    with reader(registry.root):
        while rounds < 2 or time.monotonic() < end:
            content = ("two", "one")[rounds % 2]
            publish(registry, content, named("cabinet-1"))
            publish(registry, content, named("cabinet-2"))
            registry.add(named("chest-1", status="rejected", reason=REJECTED.reason), BAD_REPORT)
            rebuild(registry.root)
            publish(registry, content, named("chest-1"))
            registry.note("cabinet-2", tags=(f"round-{rounds}",))
            collect_garbage(registry.root, keep_bytes=0)
            rounds += 1
    assert verify(registry) == ()


def publish_many(root, name, count, together):
    together.wait()
    registry = Registry(root, create=True)
    for number in range(count):
        publish(registry, name, named("cabinet-1"))
        publish(registry, name, named(f"{name}-{number}"))


def test_several_jobs_that_make_one_registry_at_once_lose_nothing(tmp_path):
    context = multiprocessing.get_context("fork")
    together = context.Barrier(4)
    calls = [(tmp_path, name, 3, together) for name in ("one", "two", "three", "four")]
    jobs = [context.Process(target=publish_many, args=call) for call in calls]
    for job in jobs:
        job.start()
    for job in jobs:
        job.join(60)
        assert job.exitcode == 0
    registry = Registry(tmp_path)
    assert registry.count() == 13
    assert verify(registry) == ()
