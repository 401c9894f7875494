"""What only simulators refuse is repaired too: the guess that is worth least is given up."""

from dataclasses import replace
from pathlib import Path

import pytest

from asset_factory.factory.articulate import standing
from asset_factory.factory.articulate.proposal import Hypothesis
from asset_factory.factory.build import build_asset
from asset_factory.factory.config import BuildConfig
from asset_factory.factory.registry import Registry
from asset_factory.factory.registry.report_file import read_report
from asset_factory.factory.verify import rounds
from asset_factory.factory.verify.validate import Verdict
from asset_factory.sim_checks import Finding, Severity

FRIDGE = Path(__file__).resolve().parents[3] / "examples" / "meshes" / "fridge.obj"
CONFIG = BuildConfig(articulator="geometric", simulators=())


@pytest.fixture
def guessed(monkeypatch):
    """The joints of the example, as guesses, the surest first."""
    names = []
    likeliest = standing.hypotheses

    def hypotheses(*asked):
        hypothesis, *_ = likeliest(*asked)
        right = hypothesis.articulation
        joints = tuple(
            replace(joint, confidence=0.9 - 0.6 * number)
            for number, joint in enumerate(right.joints)
        )
        names[:] = [joint.name for joint in joints]
        return (Hypothesis(replace(right, joints=joints)),)

    monkeypatch.setattr(standing, "hypotheses", hypotheses)
    return names


def refusing(monkeypatch, number, names, code):
    """A simulator that says of one joint, while it is there, that it fails."""
    honest = rounds.validate

    def validate(bundle, *asked):
        verdict = honest(bundle, *asked)
        name = names[number]
        if f'"{name}"' not in bundle.urdf.read_text(encoding="utf-8"):
            return verdict
        found = Finding(code, Severity.ERROR, f"bullet: {name} is stuck", "bullet", name)
        return Verdict(replace(verdict.report, findings=(*verdict.report.findings, found)))

    monkeypatch.setattr(rounds, "validate", validate)


def repairs(result, output):
    stored = read_report(Registry(output).assets / result.entry.id)
    return " ".join(repair.sentence for repair in stored.repairs)


def test_a_guess_that_jams_in_a_simulator_is_given_up_and_told(output, monkeypatch, guessed):
    refusing(monkeypatch, -1, guessed, "jammed")
    result = build_asset(FRIDGE, output, CONFIG)
    assert result.entry.status == "passed"
    assert result.entry.joints == len(guessed) - 1
    assert f"gave up {guessed[-1]}: bullet: {guessed[-1]} is stuck" in repairs(result, output)


def test_what_no_guess_brings_about_costs_none(output, monkeypatch, guessed):
    refusing(monkeypatch, -1, guessed, "no_mass")
    entry = build_asset(FRIDGE, output, CONFIG).entry
    assert (entry.status, entry.reason, entry.joints) == ("rejected", "no_mass", len(guessed))


def test_the_best_guess_is_never_given_up(output, monkeypatch, guessed):
    refusing(monkeypatch, 0, guessed, "jammed")
    entry = build_asset(FRIDGE, output, CONFIG).entry
    assert (entry.status, entry.reason) == ("rejected", "jammed")
