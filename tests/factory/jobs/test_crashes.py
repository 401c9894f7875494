"""A crash that comes again is a verdict; one that may have been bad luck is tried again."""

import ctypes
import json
import os

import pytest
from job_samples import PLAIN, job, made, note, write_inputs

from asset_factory.factory.jobs import Budget, LocalExecutor
from asset_factory.factory.registry import Registry, keys
from asset_factory.factory.runtime.clock import Stopwatch


def dying(source, **rest):
    """In place of a build: it dies in a stage, and the input's name says how."""
    note(source)
    clock = Stopwatch()
    with clock.stage("load"):
        pass
    stage = f"stage_{os.getpid()}" if "wanders" in source.name else "decompose"
    with clock.stage(stage), clock.stage("hulls"):
        pass
    with clock.stage(stage):
        if "ended" in source.name:
            os.kill(os.getpid(), 15)
        if "leaves" in source.name:
            os._exit(3)
        # Native code reads where nothing is.
        ctypes.string_at(0)


@pytest.fixture(autouse=True)
def _dying(builds_are):
    builds_are(dying)


def built(tmp_path, name, retries=1, **more):
    inputs = write_inputs(tmp_path / "in", 0, name)
    executor = LocalExecutor(1, retries=retries)
    (result,) = job(inputs, tmp_path / "out", PLAIN, executor=executor, **more).run()
    return result


def test_two_deaths_in_one_stage_are_a_verdict_with_a_trace_that_waits(tmp_path, monkeypatch):
    result = built(tmp_path, "dies")
    assert (result.entry.status, result.entry.reason) == ("unjudged", "crashed")
    assert "SIGSEGV, 2 times; each time in stage 'decompose', at " in result.entry.message
    folder = tmp_path / "out" / "rejected" / result.entry.id
    told = json.loads((folder / "report.json").read_text())["measurements"]["crash"]
    assert told["stage"] == "decompose"
    assert any("factory/jobs/test_crashes.py:" in line for line in told["trace"])
    assert not any(line.startswith("/") for line in told["trace"])
    assert built(tmp_path, "dies").known
    assert made(tmp_path / "in") == ["dies.stl"] * 2
    # Until somebody asks, or the program is another.
    assert not built(tmp_path, "dies", budget=Budget(retry=("crashed",))).known
    assert built(tmp_path, "dies").known
    monkeypatch.setattr(keys, "__version__", "99.0")
    assert not built(tmp_path, "dies").known
    assert [entry.reason for entry in Registry(tmp_path / "out").entries()] == ["crashed"]


def test_a_death_a_night_is_a_verdict_after_the_second(tmp_path):
    assert built(tmp_path, "dies", retries=0).entry.reason == "build_crashed"
    second = built(tmp_path, "dies", retries=0)
    assert (second.known, second.entry.reason) == (False, "crashed")
    assert built(tmp_path, "dies", retries=0).known


def test_leaving_without_a_word_is_a_death_too(tmp_path):
    assert built(tmp_path, "leaves").entry.reason == "crashed"


@pytest.mark.parametrize("name", ["wanders", "ended"])
def test_a_death_elsewhere_or_by_another_hand_is_tried_again(tmp_path, name):
    for retries in (1, 0):
        result = built(tmp_path, name, retries)
        wanted = (False, "build_crashed", 1 + retries)
        assert (result.known, result.entry.reason, result.attempts) == wanted
