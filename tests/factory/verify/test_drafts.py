"""Of several readings the likeliest that passes whole becomes the asset; the others are told."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from export_samples import cabinet
from modelled_furniture import METAL, PAINT, board

from asset_factory.factory.articulate import standing
from asset_factory.factory.articulate.proposal import Hypothesis
from asset_factory.factory.build import build_asset
from asset_factory.factory.config import BuildConfig, ReadingsConfig
from asset_factory.factory.errors import InputRejected
from asset_factory.factory.manufacture.plan import Plan
from asset_factory.factory.mesh import concatenate
from asset_factory.factory.registry import Registry
from asset_factory.factory.registry.report_file import read_report
from asset_factory.factory.verify import rounds
from asset_factory.factory.verify.drafts import HypothesisDraft, best_of
from asset_factory.factory.verify.validate import Verdict
from asset_factory.sim_checks import Finding, Report, Severity
from asset_factory.sim_checks.report import OUT_OF_TIME

DEEP = Finding("sweep_penetration", Severity.ERROR, "5 mm deep", value=5.0, unit="mm", limit=2.0)
ASSET = cabinet()


def draft(*findings, frozen=frozenset()):
    report = Report("asset.urdf", findings=findings)
    plan = Plan(frozen=frozen)
    return HypothesisDraft(ASSET.articulation, ASSET, None, plan, (), Verdict(report))


def test_the_first_that_passes_whole_is_the_last_that_is_made():
    rejected, whole, never = draft(DEEP), draft(), draft()
    made = []

    def drafts():
        for each in (rejected, whole, never):
            made.append(each)
            yield each

    best, others = best_of(drafts())
    assert best is whole
    assert made == [rejected, whole]
    (told,) = others
    assert told.code == "other_reading"
    assert "is rejected, sweep_penetration: 5 mm deep" in told.message
    assert all(f"{part.name} " in told.message for part in ASSET.articulation.parts[1:])


def test_one_that_passes_without_a_joint_is_better_than_none_and_worse_than_whole():
    lame = draft(frozen=frozenset({"hinge"}))
    assert best_of(iter([draft(DEEP), lame]))[0] is lame
    best, (told,) = best_of(iter([lame, draft()]))
    assert best.whole
    assert "passes only without hinge" in told.message
    # Where none passes, the likeliest is rejected.
    first = draft(DEEP)
    assert best_of(iter([first, draft(DEEP)]))[0] is first


def _blocked(right):
    """The same with its first door hinged on an axis through the middle of the carcass."""
    joint = right.movable_joints[0]
    middle = right.mesh.bounds.mean(axis=0)
    wrong = replace(joint, origin=middle, axis=np.array([0.0, 0.0, 1.0]), upper=1.5)
    return replace(right, joints=tuple(wrong if j is joint else j for j in right.joints))


def _reading_as(monkeypatch, *changes):
    likeliest = standing.hypotheses

    def hypotheses(*asked):
        right, *_ = likeliest(*asked)
        return tuple(Hypothesis(change(right.articulation)) for change in changes)

    monkeypatch.setattr(standing, "hypotheses", hypotheses)


CONFIG = BuildConfig(articulator="geometric", simulators=())


@pytest.fixture(scope="module")
def one_door(tmp_path_factory):
    """A block with a door and its bar: one joint, which rules of shape find."""
    block = board((0.0, 0.0, 0.0), (0.6, 0.6, 1.0))
    door = board((0.0, -0.06, 0.02), (0.6, -0.001, 0.98), PAINT)
    bar = board((0.05, -0.1, 0.4), (0.08, -0.06, 0.7), METAL)
    mesh = concatenate([block, door, bar])
    file = tmp_path_factory.mktemp("one_door") / "cupboard.obj"
    trimesh.Trimesh(mesh.vertices, mesh.faces, process=False).export(file)
    return file


def test_a_reading_that_is_blocked_loses_to_one_that_opens(one_door, output, monkeypatch):
    _reading_as(monkeypatch, _blocked, lambda right: right)
    result = build_asset(one_door, output, CONFIG)
    assert result.entry.status == "passed"
    report = read_report(Registry(output).assets / result.entry.id).report
    (told,) = [f.message for f in report.findings if f.code == "other_reading"]
    assert told.startswith("read otherwise (")
    assert "is rejected" in told


def _impossible(right):
    """The same, of which nothing can be made, and joints of which nobody is sure."""
    joints = tuple(replace(joint, confidence=0.31) for joint in right.joints)
    return replace(right, joints=joints, notes=("impossible",))


@pytest.fixture
def impossible(monkeypatch):
    """The impossible is refused."""
    made = rounds.manufacture

    def manufacture(articulation, *asked):
        if "impossible" in articulation.notes:
            raise InputRejected("too_many_hulls", "part 'lid': needs 999 convex pieces")
        return made(articulation, *asked)

    monkeypatch.setattr(rounds, "manufacture", manufacture)
    return _impossible


def test_a_reading_that_cannot_be_made_is_passed_over_and_told(
    one_door, output, monkeypatch, impossible
):
    _reading_as(monkeypatch, impossible, lambda right: right)
    result = build_asset(one_door, output, CONFIG)
    assert result.entry.status == "passed"
    report = read_report(Registry(output).assets / result.entry.id).report
    (told,) = [f.message for f in report.findings if f.code == "other_reading"]
    assert "turns, probability 0.31), it cannot be made, too_many_hulls: part 'lid': needs" in told


def test_where_no_reading_can_be_made_the_reason_is_told(one_door, output, monkeypatch, impossible):
    _reading_as(monkeypatch, impossible)
    refused = build_asset(one_door, output, CONFIG).entry
    assert (refused.status, refused.reason) == ("rejected", "too_many_hulls")


def test_beyond_the_most_work_only_the_likeliest_is_made(one_door, output, monkeypatch):
    _reading_as(monkeypatch, _blocked, lambda right: right)
    hurried = replace(CONFIG, readings=ReadingsConfig(most_work=0))
    assert build_asset(one_door, output, hurried).entry.status == "rejected"


def test_a_reading_whose_check_hung_gives_its_place_to_no_other(one_door, output, monkeypatch):
    _reading_as(monkeypatch, lambda right: right, lambda right: right)
    honest = rounds.inspect
    late = Finding("check_timeout", Severity.ERROR, "no answer", cause=OUT_OF_TIME)
    asked = []

    def inspect(bundle, *more):
        asked.append(bundle)
        verdict = honest(bundle, *more)
        first = len(asked) == 1
        return Verdict(Report("asset.urdf", findings=(late,))) if first else verdict

    monkeypatch.setattr(rounds, "inspect", inspect)
    result = build_asset(one_door, output, CONFIG)
    assert (result.entry.status, result.entry.reason) == ("unjudged", "check_timeout")
    assert result.entry.key == ""
    assert len(asked) == 1
    assert not Registry(output).known_keys([""])
    assert build_asset(one_door, output, CONFIG).entry.status == "passed"


def test_a_simulator_that_hung_neither_rejects_nor_repairs(one_door, output, monkeypatch):
    honest = rounds.validate
    late = Finding("simulator_timeout", Severity.ERROR, "no answer", "bullet", cause=OUT_OF_TIME)
    jammed = Finding("jammed", Severity.ERROR, "sapien: stuck", "sapien")

    def validate(*asked):
        verdict = honest(*asked)
        return replace(verdict, report=replace(verdict.report, findings=(jammed, late)))

    monkeypatch.setattr(rounds, "validate", validate)
    entry = build_asset(one_door, output, CONFIG).entry
    assert (entry.status, entry.reason) == ("unjudged", "simulator_timeout")
