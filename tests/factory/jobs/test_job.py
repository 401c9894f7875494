"""A job does each thing once, says what it did, and goes on where another one stopped."""

import errno
import json
import os
import shutil
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from unittest.mock import Mock

import numpy as np
import pytest
from job_samples import PLAIN, job, made, pretend, write_inputs

from asset_factory.factory.errors import ConfigError, InputRejected, RegistryError
from asset_factory.factory.intake import source as source_module
from asset_factory.factory.intake.source import Source
from asset_factory.factory.jobs import Budget, LocalExecutor, budget, run_builds
from asset_factory.factory.jobs import job as job_module
from asset_factory.factory.jobs.budget import modified_since, parse_since
from asset_factory.factory.jobs.probe import KnownReads
from asset_factory.factory.registry import Registry, claims
from asset_factory.factory.registry.logged import LOG_NAME
from asset_factory.factory.registry.product import Product, refused, without_asset
from asset_factory.factory.registry.registration import register
from asset_factory.factory.registry.report_file import BuildReport
from asset_factory.factory.registry.result import Result
from asset_factory.factory.runtime.stages import Stages
from asset_factory.factory.runtime.store import Store, digest_file, folder_digests
from asset_factory.sim_checks import Finding, Report, Severity
from asset_factory.sim_checks.report import KILLED, OUT_OF_TIME, Status


@pytest.fixture(autouse=True)
def _pretending(monkeypatch, builds_are):
    builds_are(pretend)
    monkeypatch.setattr(job_module, "POLL_S", 0.01)


def test_the_same_job_again_does_nothing_and_every_build_is_logged(tmp_path):
    inputs = write_inputs(tmp_path / "in", 5)
    first = list(job(inputs, tmp_path / "out").run())
    assert [result.attempts for result in first] == [1] * 5
    calls = made(tmp_path / "in")
    again = list(job(inputs, tmp_path / "out").run())
    assert made(tmp_path / "in") == calls
    assert all(result.known and result.reused == ("build",) for result in again)
    assert [(r.input, r.entry) for r in again] == [(r.input, r.entry) for r in first]
    lines = [json.loads(line) for line in (tmp_path / "out" / LOG_NAME).read_text().splitlines()]
    assert [line["event"] for line in lines[:7]] == ["begun", *["built"] * 5, "ended"]
    assert lines[1]["stages"][-1]["stage"] == "register"
    assert lines[6] | {"state": "finished", "built": 5, "left": 0} == lines[6]


def test_a_job_leaves_no_more_of_the_cache_than_its_settings_say(tmp_path):
    inputs = write_inputs(tmp_path / "in", 1)
    store = Store(tmp_path / "out" / ".cache")
    for name, age_s in (("old", 7200.0), ("new", 0.0)):
        store.save(f"stage-{name}", {"a": np.arange(1000)})
        (file,) = store.root.rglob(f"stage-{name}.npz")
        os.utime(file, (time.time() - age_s,) * 2)
    list(job(inputs, tmp_path / "out", replace(PLAIN, cache_gb=1e-7)).run())
    assert store.load("stage-old") is None
    assert store.load("stage-new") is not None


def test_only_what_is_missing_or_another_is_built(tmp_path):
    inputs = write_inputs(tmp_path / "in", 4)
    list(job(inputs[:2], tmp_path / "out").run())
    inputs[0].write_text("solid other")
    (tmp_path / "in" / "thing_1.toml").write_text('category = "fridge"')
    results = {Path(r.input).name: r.attempts for r in job(inputs, tmp_path / "out").run()}
    assert results == {"thing_0.stl": 1, "thing_1.stl": 1, "thing_2.stl": 1, "thing_3.stl": 1}
    assert all(result.known for result in job(inputs, tmp_path / "out").run())


def test_other_settings_are_another_build_but_other_limits_are_not(tmp_path):
    inputs = write_inputs(tmp_path / "in", 2)
    list(job(inputs, tmp_path / "out").run())
    patient = replace(PLAIN, asset_wall_s=1.0, asset_memory_bytes=2**30, retries=0)
    assert all(result.known for result in job(inputs, tmp_path / "out", patient).run())
    heavier = replace(PLAIN, inertia=replace(PLAIN.inertia, density=700.0))
    assert not any(result.known for result in job(inputs, tmp_path / "out", heavier).run())


def test_a_moved_folder_a_lost_cache_and_a_relative_path_change_nothing(tmp_path, monkeypatch):
    inputs = write_inputs(tmp_path / "in", 2)
    list(job(inputs, tmp_path / "out").run())
    (tmp_path / "in").rename(tmp_path / "moved")
    shutil.rmtree(tmp_path / "out" / ".cache", ignore_errors=True)
    moved = tuple(tmp_path / "moved" / path.name for path in inputs)
    assert all(result.known for result in job(moved, tmp_path / "out").run())
    monkeypatch.chdir(tmp_path / "moved")
    (result,) = job((Path("thing_0.stl"),), Path("../out")).run()
    assert (result.known, result.input) == (True, "thing_0.stl")


def test_a_limit_leaves_the_rest_to_the_next_job_and_out_of_time_begins_nothing(tmp_path):
    inputs = write_inputs(tmp_path / "in", 5)
    late = job(inputs, tmp_path / "out", budget=Budget(max_s=0.0))
    assert list(late.run()) == []
    assert (late.state, late.left) == ("out_of_time", 5)
    assert made(tmp_path / "in") == []
    short = job(inputs, tmp_path / "out", budget=Budget(limit=2))
    assert len(list(short.run())) == 2
    assert (short.state, short.left) == ("limit_reached", 3)
    # Those known from before do not count.
    more = job(inputs, tmp_path / "out", budget=Budget(limit=2))
    assert [result.attempts for result in more.run()] == [0, 0, 1, 1]
    assert more.left == 1
    enough = job(inputs, tmp_path / "out", budget=Budget(limit=1))
    assert len(list(enough.run())) == 5
    assert (enough.state, enough.left) == ("finished", 0)


def test_what_was_rejected_stays_rejected_until_somebody_asks(tmp_path):
    inputs = write_inputs(tmp_path / "in", 1, "bad")
    list(job(inputs, tmp_path / "out").run())
    for retry, times in (((), 1), (("pretty",), 1), (("ugly",), 2), (("any",), 3)):
        results = list(job(inputs, tmp_path / "out", budget=Budget(retry=retry)).run())
        assert [result.entry.status for result in results] == ["passed", "rejected"]
        assert made(tmp_path / "in").count("bad.stl") == times
    assert made(tmp_path / "in").count("thing_0.stl") == 1


def test_a_hang_is_listed_and_tried_again_by_the_next_job(tmp_path):
    inputs = write_inputs(tmp_path / "in", 1, "nap")
    hurried = replace(PLAIN, asset_wall_s=1.0)
    for _ in range(2):
        executor = LocalExecutor(1, retries=0)
        (result,) = job(inputs[1:], tmp_path / "out", hurried, executor=executor).run()
        assert (result.entry.status, result.entry.reason) == ("unjudged", "build_timeout")
        assert "no answer within 1 s" in result.entry.message
        assert not result.known
    again = job(inputs, tmp_path / "out", PLAIN, budget=Budget(limit=0))
    assert list(again.run()) == []
    assert again.left == 2
    # What is judged later takes the place of what was listed.
    list(run_builds(inputs, tmp_path / "out", PLAIN, workers=1))
    entries = {entry.name: entry.status for entry in Registry(tmp_path / "out").entries()}
    assert entries == {"nap": "passed", "thing_0": "passed"}


@pytest.mark.parametrize("damage", ["altered", "missing", "extra"])
def test_what_was_damaged_is_built_again_when_asked(tmp_path, damage):
    inputs = write_inputs(tmp_path / "in", 2)
    first, _ = job(inputs, tmp_path / "out").run()
    folder = tmp_path / "out" / "assets" / first.entry.id
    before = folder_digests(folder)
    if damage == "missing":
        (folder / "asset.urdf").unlink()
    else:
        damaged = folder / ("asset.urdf" if damage == "altered" else "note.txt")
        damaged.write_text("<robot name='other'/>")
    assert all(result.known for result in job(inputs, tmp_path / "out").run())
    repaired = list(job(inputs, tmp_path / "out", budget=Budget(repair=True)).run())
    found = sorted((result.entry.id == first.entry.id, result.known) for result in repaired)
    assert found == [(False, True), (True, False)]
    assert folder_digests(folder) == before
    again = job(inputs, tmp_path / "out", budget=Budget(repair=True)).run()
    assert all(result.known for result in again)


def test_a_folder_that_is_gone_is_built_again_unasked(tmp_path):
    inputs = write_inputs(tmp_path / "in", 1)
    (first,) = job(inputs, tmp_path / "out").run()
    shutil.rmtree(tmp_path / "out" / "assets" / first.entry.id)
    assert [result.known for result in job(inputs, tmp_path / "out").run()] == [False]


def test_a_full_disk_ends_the_job_with_one_sentence_and_nothing_half_done(tmp_path):
    inputs = write_inputs(tmp_path / "in", 1, "full")
    with pytest.raises(RegistryError, match="cannot be written: No space left on device"):
        list(job(inputs, tmp_path / "out").run())
    assert [entry.name for entry in Registry(tmp_path / "out").entries()] == ["thing_0"]
    assert list((tmp_path / "out" / ".staging").iterdir()) == []
    assert list((tmp_path / "out" / ".claims").iterdir()) == []


def test_an_output_that_became_read_only_ends_the_job_but_what_is_known_is_told(
    tmp_path, monkeypatch
):
    inputs = write_inputs(tmp_path / "in", 2)
    list(job(inputs[:1], tmp_path / "out").run())
    closed = OSError(errno.EROFS, "Read-only file system", str(tmp_path / "out"))
    monkeypatch.setattr(job_module, "Log", Mock(side_effect=closed))
    results = []
    with pytest.raises(RegistryError, match="out: cannot be written: Read-only file system"):
        results += job(inputs, tmp_path / "out").run()
    assert [result.known for result in job(inputs[:1], tmp_path / "out").run()] == [True]


def test_two_jobs_on_one_registry_make_each_asset_once(tmp_path):
    inputs = write_inputs(tmp_path / "in", 30)
    results = {}

    def work(number):
        order = inputs if number else inputs[::-1]
        results[number] = sorted(Path(r.input).name for r in job(order, tmp_path / "out").run())

    with ThreadPoolExecutor(3) as pool:
        list(pool.map(work, range(3)))
    everything = sorted(path.name for path in inputs)
    assert sorted(made(tmp_path / "in")) == everything
    assert results == dict.fromkeys(range(3), everything)
    assert len(Registry(tmp_path / "out").entries()) == 30


def test_a_job_that_is_over_does_not_wait_for_another(tmp_path):
    inputs = write_inputs(tmp_path / "in", 2)
    ours = job(inputs, tmp_path / "out", budget=Budget(limit=1))
    claim = KnownReads(tmp_path / "out" / ".cache", PLAIN).probe(inputs[0]).claim
    theirs = claims.claim(tmp_path / "out" / ".claims", claim)
    (result,) = ours.run()
    assert (Path(result.input).name, ours.state, ours.left) == ("thing_1.stl", "limit_reached", 1)
    theirs.close()


def test_two_files_of_one_name_and_content_are_built_once(tmp_path):
    inputs = (*write_inputs(tmp_path / "in", 1), *write_inputs(tmp_path / "copy", 1))
    results = list(job(inputs, tmp_path / "out").run())
    assert sorted(Path(result.input).parent.name for result in results) == ["copy", "in"]
    assert len(made(tmp_path / "in") + made(tmp_path / "copy")) == 1


def test_what_an_input_without_rights_was_listed_as_goes_once_it_has_them(tmp_path, monkeypatch):
    (path,) = write_inputs(tmp_path / "in", 1)
    registry = Registry(tmp_path / "out", create=True)
    with monkeypatch.context() as closed:
        # Root reads what nobody may.
        closed.setattr(source_module, "content_digest", lambda path: "")
        refusal = InputRejected("unreadable", "no rights")
        register(registry, refused(Source(path, PLAIN), refusal, Stages(PLAIN)))
    assert [entry.reason for entry in registry.entries()] == ["unreadable"]
    asset = replace(registry.entries()[0], id="thing", status="passed", reason="", message="")
    with registry.staging_folder() as staging:
        (staging / "made").mkdir()
        ids = Source(path, PLAIN).unloaded_ids
        result = Result(str(path), asset)
        register(registry, Product(result, BuildReport(Report("")), staging / "made", ids))
    assert [entry.id for entry in registry.entries()] == ["thing"]


def test_that_something_was_stopped_is_not_remembered_as_an_answer(tmp_path):
    (path,) = write_inputs(tmp_path / "in", 1)
    origin = Source(path, PLAIN)
    origin.reads = {path.name: digest_file(path)}
    for cause, remembered in ((KILLED, False), (OUT_OF_TIME, False), (None, True)):
        message = "mujoco died on asset.xml"
        finding = Finding("simulator_crashed", Severity.ERROR, message, cause=cause)
        assert bool(without_asset(origin, finding, Status.UNJUDGED)[0].key) == remembered


def test_a_point_in_time_is_seconds_ago_a_date_or_a_file(tmp_path, monkeypatch):
    monkeypatch.setattr(budget, "time", lambda: 10_000.0)
    assert parse_since("3600") == 6_400.0
    assert parse_since("2026-11-21T00:00+00:00") == 1_795_219_200.0
    assert parse_since("2026-11-21T01:00+01:00") == 1_795_219_200.0
    stamp = tmp_path / "stamp"
    stamp.touch()
    os.utime(stamp, (500.0, 500.0))
    assert parse_since(str(stamp)) == 500.0
    for text in ("yesterday", "-1", "nan", str(tmp_path / "nothing")):
        with pytest.raises(ConfigError, match="must be seconds ago, a date such as"):
            parse_since(text)


def test_only_what_was_modified_since_is_wanted(tmp_path):
    for name, modified in (("old", 100.0), ("new", 300.0)):
        (tmp_path / name).touch()
        os.utime(tmp_path / name, (modified, modified))
    paths = (tmp_path / "old", tmp_path / "new", tmp_path / "gone")
    assert list(modified_since(paths, 200.0)) == [tmp_path / "new", tmp_path / "gone"]
