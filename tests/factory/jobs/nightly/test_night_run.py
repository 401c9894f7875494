"""Whole nights, with builds that are made up: budgets, interruptions, damage, files on disk."""

import json
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from types import SimpleNamespace
from unittest.mock import Mock

import pytest

from asset_factory.factory.errors import ConfigError, RegistryError
from asset_factory.factory.jobs.nightly import run as night
from asset_factory.factory.jobs.nightly.licenses import Licenses
from asset_factory.factory.jobs.nightly.settings import NightConfig, Upkeep
from asset_factory.factory.registry import Entry
from asset_factory.factory.registry.result import Result
from asset_factory.factory.registry.verify import Problem, Settled
from asset_factory.factory.report.nightly.figures import SourceRules
from asset_factory.factory.report.nightly.files import JOURNAL
from asset_factory.factory.report.nightly.outcome import FailureRules
from asset_factory.factory.report.nightly.table import read_table


class Workshop:
    """Builds nothing: passes what is not told to fail, and knows it the next time."""

    def __init__(self, folder, names):
        self.folder = folder
        self.registry = self
        self.settings = {"executor": "made up"}
        self.rejected = set()
        self.known = {}
        self.damage = ()
        self.mendable = set()
        self.interrupt_after = None
        self.most_hours = None
        self.hours = 0
        self.closed = 0
        self.begun = []
        self.add(names)

    def add(self, names):
        for name in names:
            (self.folder / f"{name}.glb").write_bytes(name.encode())

    def find(self):
        return tuple(sorted(self.folder.glob("*.glb")))

    def job(self, paths, damaged=frozenset()):
        self.urgent = damaged
        job = SimpleNamespace(state="finished", left=0, under_way=tuple)
        job.run = lambda: self.run(job, paths)
        return job

    def run(self, job, paths):
        try:
            for done, path in enumerate(paths):
                if done == self.interrupt_after:
                    raise KeyboardInterrupt
                if self.hours == self.most_hours:
                    job.state = "out_of_time"
                    return
                self.begun.append(path.stem)
                yield self.result(path)
                self.hours += 1
        finally:
            self.closed += 1

    def result(self, path):
        status = "rejected" if path.stem in self.rejected else "passed"
        reason = "" if status == "passed" else "jammed"
        key = f"{path.stem}-{status}"
        known = self.known.get(path.stem) == key
        self.known[path.stem] = key
        told = {"key": key, "message": reason}
        entry = Entry(f"{path.stem}-00", path.stem, "", status, reason, 0, 0, 0, **told)
        result = Result(str(path), entry, seconds=5.0)
        return replace(result, attempts=0, seconds=0.01, reused=("build",)) if known else result

    def walk(self):
        known = [(name, key.split("-")[1]) for name, key in sorted(self.known.items())]
        return tuple(Entry(f"{name}-00", name, "", status, "", 1, 1, 1) for name, status in known)

    def now(self):
        return datetime(2026, 11, 21, 1, tzinfo=UTC) + timedelta(hours=self.hours)

    def settle(self, damage, *, final):
        ids = {problem.id for problem in damage}
        mended = self.mendable & ids
        lost = Settled.WITHDRAWN if final else Settled.LEFT
        return {each: Settled.MENDED if each in mended else lost for each in ids}

    def tidy(self):
        return "nothing"

    def follow(self, results, total, under_way):
        return results


@pytest.fixture
def workshop(tmp_path, monkeypatch):
    monkeypatch.setattr(night, "verify", lambda workshop: workshop.damage)
    monkeypatch.setattr(night, "mend_rows", lambda *_: None)
    monkeypatch.setattr(night, "settle", Workshop.settle)
    (tmp_path / "in").mkdir()
    return Workshop(tmp_path / "in", ["a", "b", "c"])


@pytest.fixture
def config(tmp_path):
    return NightConfig(output=tmp_path / "out")


def run(workshop, config, **more):
    return night.run_night(config, workshop, **more)


def summary(config, name):
    return json.loads((config.output / "nights" / name / "summary.json").read_text())


def test_three_nights_make_a_trend(workshop, config):
    first = run(workshop, config)
    wanted = ("0001", 3, 0, ())
    assert (first.night.name, first.night.passed, first.night.exit_code, first.attention) == wanted
    workshop.add(["d", "e"])
    workshop.rejected = {"d", "e"}
    second = run(workshop, config)
    assert (second.night.name, second.night.exit_code, second.night.known) == ("0002", 5, 3)
    unchanged = dict.fromkeys(("newly passed", "newly failed", "changed", "gone"), 0)
    assert second.registry == {"new": 2, **unchanged, "same": 3}
    workshop.rejected = {"a"}
    third = run(workshop, config)
    assert [c.now.id for c in third.changes.failing] == ["a-00"]
    assert [c.now.id for c in third.changes.passing] == ["d-00", "e-00"]
    assert [point.name for point in third.trend] == ["0001", "0002", "0003"]
    nights = config.output / "nights"
    wanted = ["0001", "0002", "0003", "index.html", "message.txt"]
    assert sorted(path.name for path in nights.iterdir()) == wanted
    names = {"summary.json", "attempts.parquet", "index.html", "message.txt", "night.log"}
    assert {path.name for path in (nights / "0003").iterdir()} == names
    assert read_table(nights / "0003" / "attempts.parquet") == third.attempts
    assert "(+20.0 points)" not in (nights / "0003" / "message.txt").read_text()
    assert summary(config, "0003")["against"]["newly_failing"][0]["id"] == "a-00"


@pytest.mark.parametrize("killed", [False, True])
def test_an_interrupted_night_has_a_page_and_goes_on_also_where_it_left_a_journal_only(
    workshop, config, killed
):
    workshop.interrupt_after = 2
    report = run(workshop, config)
    assert (report.night.exit_code, report.night.passed, report.night.waiting) == (130, 2, 1)
    assert workshop.closed == 1
    folder = config.output / "nights" / "0001"
    assert "interrupted" in (folder / "index.html").read_text()
    for path in folder.iterdir() if killed else ():
        if path.name != JOURNAL:
            path.unlink()
    workshop.interrupt_after = None
    again = run(workshop, config)
    night = again.night
    assert (night.name, night.state, night.passed, night.exit_code) == ("0001", "finished", 3, 0)
    assert [attempt.seconds for attempt in again.attempts] == [5.0, 5.0, 5.0]
    assert night.known == 0
    assert killed or (night.started, night.seconds) == (report.night.started, 5 * 3600.0)
    assert not (folder / JOURNAL).exists()
    assert run(workshop, config).night.name == "0002"


def test_a_new_night_leaves_the_interrupted_one_as_it_is(workshop, config):
    workshop.interrupt_after = 1
    run(workshop, config)
    workshop.interrupt_after = None
    report = run(workshop, config, fresh=True)
    assert (report.night.name, report.night.passed) == ("0002", 3)
    assert summary(config, "0001")["night"]["state"] == "interrupted"
    assert report.before is not None
    assert run(workshop, config).night.name == "0003"


def test_a_night_that_ran_out_of_time_is_finished_and_says_what_is_left(workshop, config):
    workshop.most_hours = 2
    report = run(workshop, config)
    assert (report.night.state, report.night.passed, report.night.waiting) == ("out_of_time", 2, 1)
    assert report.night.exit_code == 0
    assert report.attention == ("Not begun: 1 input; the next night takes them up.",)
    workshop.most_hours = None
    assert (run(workshop, config).night.name, run(workshop, config).night.passed) == ("0002", 3)


def test_what_may_not_be_built_is_not_begun(workshop, config):
    (workshop.folder / "b.toml").write_text("license = 'Proprietary'\n")
    report = run(workshop, replace(config, licenses=Licenses(("CC0-1.0",))))
    assert workshop.begun == ["a", "c"]
    assert (report.night.left_out, report.night.found, report.night.waiting) == (1, 3, 0)
    assert "Proprietary" in (config.output / "nights" / "0001" / "index.html").read_text()


def test_assets_from_before_a_license_was_disallowed_are_pointed_out(workshop, config):
    run(workshop, config)
    (workshop.folder / "b.toml").write_text("license = 'Proprietary'\n")
    report = run(workshop, replace(config, licenses=Licenses(("CC0-1.0",), unknown=False)))
    # Also the one whose input was not begun.
    assert len(report.not_allowed) == 3
    assert "License not allowed: 3 registered assets." in report.attention


def test_a_night_that_cannot_begin_leaves_nothing(workshop, config):
    workshop.find = Mock(side_effect=ConfigError("input x: does not exist"))
    with pytest.raises(ConfigError, match="does not exist"):
        run(workshop, config)
    assert not (config.output / "nights").exists()


def test_nothing_is_tidied_where_that_is_not_wanted(workshop, config):
    workshop.tidy = Mock(side_effect=AssertionError)
    assert run(workshop, replace(config, upkeep=Upkeep(enabled=False))).night.passed == 3


def test_an_output_that_cannot_be_written_is_one_sentence(workshop, config):
    config.output.mkdir()
    (config.output / "nights").write_text("in the way")
    with pytest.raises(RegistryError, match="nights: File exists; what was finished is registered"):
        run(workshop, config)


def test_what_could_be_mended_is_said_and_does_not_ring(workshop, config):
    run(workshop, config)
    workshop.damage = tuple(Problem(each, "altered", "", "is not") for each in ("a-00", "x-00"))
    workshop.mendable = {"a-00", "x-00"}
    report = run(workshop, config)
    assert workshop.urgent == {"a-00", "x-00"}
    assert (report.night.damaged, report.night.mended, report.night.exit_code) == (2, 2, 0)
    assert [item["became"] for item in summary(config, "0002")["damage"]] == ["mended"] * 2
    workshop.mendable = {"a-00"}
    report = run(workshop, config)
    assert (report.night.withdrawn, report.night.exit_code) == (1, 4)
    assert "withdrawn" in (config.output / "nights" / "0003" / "index.html").read_text()
    report = run(workshop, replace(config, mend=False))
    assert (workshop.urgent, report.night.mended, report.night.exit_code) == (frozenset(), 0, 4)
    assert run(workshop, replace(config, verify=False)).night.verified is None


def test_a_source_that_drifts_rings(workshop, config):
    failure = FailureRules(yield_drop=1.0, source=SourceRules(drop=0.1, least=3))
    config = replace(config, inputs=(workshop.folder,), failure=failure)
    for _ in range(3):
        assert run(workshop, config).night.exit_code == 0
    workshop.rejected = {"a"}
    report = run(workshop, config)
    assert report.night.exit_code == 5
    told = "66.7 %; 100 % is usual over 3 nights, 10 points less are allowed."
    assert report.attention[0] == f"The yield of {workshop.folder} is {told}"
    assert "By source" in (config.output / "nights" / "0004" / "index.html").read_text()
