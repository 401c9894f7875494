"""Of several readings the likeliest that passes whole becomes the asset; the others are told.

What only simulators refuse is repaired too: the guess that is worth least is given up.
"""

from dataclasses import replace
from itertools import chain, repeat
from unittest.mock import DEFAULT, Mock

import numpy as np
import pytest
import trimesh
from export_samples import cabinet
from modelled_furniture import METAL, PAINT, board
from repository import FRIDGE

from asset_factory.factory.articulate import standing
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


CONFIG = BuildConfig(articulator="geometric", simulators=())


@pytest.fixture(scope="module")
def one_door(tmp_path_factory):
    """A block with a door and its bar: one joint, which rules of shape find."""
    block = board((0.0, 0.0, 0.0), (0.6, 0.6, 1.0))
    door = board((0.0, -0.06, 0.02), (0.6, -0.001, 0.98), PAINT)
    mesh = concatenate([block, door, board((0.05, -0.1, 0.4), (0.08, -0.06, 0.7), METAL)])
    file = tmp_path_factory.mktemp("one_door") / "cupboard.obj"
    trimesh.Trimesh(mesh.vertices, mesh.faces, process=False).export(file)
    return file


@pytest.fixture
def built(one_door, output):
    """Builds the cupboard, or another file: the entry, and its report with the repairs."""

    def build(config=CONFIG, file=one_door):
        entry = build_asset(file, output, config).entry
        return entry, read_report(Registry(output).folder(entry)).told

    return build


@pytest.fixture
def read_as(monkeypatch):
    """Lets the object be read as the likeliest reading of it changed so, or so."""
    likeliest = standing.hypotheses

    def read(*changes):
        def hypotheses(*asked):
            right, *_ = likeliest(*asked)
            return tuple(change(right) for change in changes)

        monkeypatch.setattr(standing, "hypotheses", hypotheses)

    return read


def right(articulation):
    return articulation


def blocked(right):
    """The same with its doors hinged on one axis through the middle of the carcass."""
    middle = right.mesh.bounds.mean(axis=0)
    wrong = {"origin": middle, "axis": np.array([0.0, 0.0, 1.0]), "upper": 1.5}
    return replace(right, joints=tuple(replace(joint, **wrong) for joint in right.joints))


def impossible(right):
    """The same, of which nothing can be made, and joints of which nobody is sure."""
    joints = tuple(replace(joint, confidence=0.31) for joint in right.joints)
    return replace(right, joints=joints, notes=("impossible",))


@pytest.fixture(autouse=True)
def _impossible_is_refused(monkeypatch):
    made = rounds.manufacture

    def manufacture(articulation, *asked):
        if "impossible" in articulation.notes:
            raise InputRejected("too_many_hulls", "part 'lid': needs 999 convex pieces")
        return made(articulation, *asked)

    monkeypatch.setattr(rounds, "manufacture", manufacture)


@pytest.mark.parametrize(
    ("wrong", "why"),
    [
        (blocked, "it is rejected, "),
        (
            impossible,
            "turns, probability 0.31), it cannot be made, too_many_hulls: part 'lid': needs",
        ),
    ],
)
def test_a_reading_that_is_blocked_or_cannot_be_made_loses_to_one_that_opens_and_is_told(
    built, read_as, wrong, why
):
    read_as(wrong, right)
    entry, told = built()
    assert entry.status == "passed"
    (other,) = [f.message for f in told.report.findings if f.code == "other_reading"]
    assert other.startswith("read otherwise (")
    assert why in other


@pytest.mark.parametrize(
    ("readings", "readings_config", "reason"),
    [
        # Beyond the most work only the likeliest is made.
        ((blocked, right), ReadingsConfig(most_work=0), "sweep_penetration"),
        ((impossible,), ReadingsConfig(), "too_many_hulls"),
    ],
)
def test_where_no_reading_is_left_the_reason_is_told(
    built, read_as, readings, readings_config, reason
):
    read_as(*readings)
    entry, _ = built(replace(CONFIG, readings=readings_config))
    assert (entry.status, entry.reason) == ("rejected", reason)


def test_a_reading_whose_check_hung_gives_its_place_to_no_other(
    built, read_as, output, monkeypatch
):
    read_as(right, right)
    late = Finding("check_timeout", Severity.ERROR, "no answer", cause=OUT_OF_TIME)
    hung = Verdict(Report("asset.urdf", findings=(late,)))
    inspect = Mock(wraps=rounds.inspect, side_effect=chain([hung], repeat(DEFAULT)))
    monkeypatch.setattr(rounds, "inspect", inspect)
    entry, _ = built()
    assert (entry.status, entry.reason, entry.key) == ("unjudged", "check_timeout", "")
    assert inspect.call_count == 1
    assert not Registry(output).known_keys([""])
    assert built()[0].status == "passed"


def test_a_simulator_that_hung_neither_rejects_nor_repairs(built, monkeypatch):
    honest = rounds.validate
    late = Finding("simulator_timeout", Severity.ERROR, "no answer", "bullet", cause=OUT_OF_TIME)
    jammed = Finding("jammed", Severity.ERROR, "sapien: stuck", "sapien")

    def validate(*asked):
        verdict = honest(*asked)
        return replace(verdict, report=replace(verdict.report, findings=(jammed, late)))

    monkeypatch.setattr(rounds, "validate", validate)
    entry, _ = built()
    assert (entry.status, entry.reason) == ("unjudged", "simulator_timeout")


def guesses(right):
    """The same with joints that are guesses, the surest first."""
    joints = (replace(joint, confidence=0.9 - 0.6 * n) for n, joint in enumerate(right.joints))
    return replace(right, joints=tuple(joints))


@pytest.mark.parametrize(
    ("stuck", "code", "wanted"),
    [
        (1, "jammed", ("passed", "", 1)),
        # What no guess brings about costs none, and the best is never given up.
        (1, "no_mass", ("rejected", "no_mass", 2)),
        (0, "jammed", ("rejected", "jammed", 2)),
    ],
)
def test_a_guess_that_jams_in_a_simulator_is_given_up_and_told(
    built, read_as, monkeypatch, stuck, code, wanted
):
    read_as(guesses)
    honest = rounds.validate
    name = f"door_{stuck}_hinge"

    def validate(bundle, *asked):
        """As a simulator that says of one joint, while it is there, that it fails."""
        verdict = honest(bundle, *asked)
        if f'"{name}"' not in bundle.urdf.read_text(encoding="utf-8"):
            return verdict
        found = Finding(code, Severity.ERROR, f"bullet: {name} is stuck", "bullet", name)
        return Verdict(replace(verdict.report, findings=(*verdict.report.findings, found)))

    monkeypatch.setattr(rounds, "validate", validate)
    entry, told = built(file=FRIDGE)
    assert (entry.status, entry.reason, entry.joints) == wanted
    given_up = f"gave up {name}: bullet: {name} is stuck"
    assert (given_up in " ".join(each.sentence for each in told.repairs)) == (not wanted[1])
