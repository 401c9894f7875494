"""Rights to work end with whoever had them, and only one of several makes a registry."""

import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from registry_samples import named, publish

from asset_factory.factory.registry import Registry
from asset_factory.factory.registry.claims import claim, drop_abandoned
from asset_factory.factory.registry.cleaning import collect_garbage

HOLDS = """import sys, time, pathlib
from asset_factory.factory.registry.claims import claim
held = claim(pathlib.Path(sys.argv[1]), "work")
print("held", flush=True)
time.sleep(60)"""


def test_a_claim_is_had_by_one_until_it_is_released(tmp_path):
    first = claim(tmp_path / "claims", "work")
    assert claim(tmp_path / "claims", "work") is None
    other = claim(tmp_path / "claims", "other")
    first.release()
    again = claim(tmp_path / "claims", "work")
    again.release()
    other.release()
    assert list((tmp_path / "claims").iterdir()) == []


def test_a_claim_ends_with_its_process(tmp_path):
    command = [sys.executable, "-c", HOLDS, str(tmp_path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "held\n"
        assert claim(tmp_path, "work") is None
        process.kill()
        process.wait()
        mine = claim(tmp_path, "work")
    mine.release()
    assert not Path(tmp_path / "work").exists()


def test_claims_of_the_dead_are_dropped_those_of_the_living_are_not(tmp_path):
    registry = Registry(tmp_path / "out", create=True)
    folder = tmp_path / "out" / ".claims"
    held = claim(folder, "held")
    (folder / "left").touch()
    collect_garbage(registry.root)
    assert [path.name for path in folder.iterdir()] == ["held"]
    held.release()
    assert drop_abandoned(folder) == 0


def test_several_who_make_a_registry_at_once_lose_nothing(tmp_path):
    count = 8
    together = threading.Barrier(count)

    def work(number):
        together.wait()
        publish(Registry(tmp_path / "out", create=True), entry=named(f"cabinet-{number}"))

    with ThreadPoolExecutor(count) as pool:
        list(pool.map(work, range(count)))
    assert len(Registry(tmp_path / "out").entries()) == count
