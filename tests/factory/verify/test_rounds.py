"""Rounds around repairs: fewer hulls where there are too many, and hinges left open as drawn.

A report tells what share of ranges and surfaces is left.
"""

from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from test_mend import cabinet

from asset_factory.factory.articulate.drawn import close_seen, left_open
from asset_factory.factory.articulation import JointKind, rotation_about
from asset_factory.factory.config import BuildConfig, HullsConfig
from asset_factory.factory.manufacture.plan import Plan
from asset_factory.factory.part import PartSource, Proposer
from asset_factory.factory.verify import rounds
from asset_factory.factory.verify.drafts import HypothesisDraft
from asset_factory.factory.verify.kept import KEPT, with_kept
from asset_factory.factory.verify.rounds import Rounds
from asset_factory.factory.verify.validate import Verdict
from asset_factory.sim_checks import Report

MOST = 100


@dataclass(frozen=True)
class Draft:
    plan: Plan
    asset: Any
    passes: bool = True
    before: Any = None
    inspected: Any = None
    work: int = 0


def drafted(monkeypatch, cut_off, refused_below=0, fat=0):
    """Made of 150 hulls before cutting, or what is asked for; cutting adds so many.

    Where hulls were joined it adds ``fat`` besides: what is coarser is more in the way.
    """
    aims = []

    def made(self, plan, folder, done=0):
        aims.append(plan.fewer)
        count = 150 if plan.fewer is None else min(150, plan.fewer) + fat
        count += cut_off
        return Draft(plan, SimpleNamespace(hull_count=count), count >= refused_below)

    monkeypatch.setattr(Rounds, "_made", made)
    monkeypatch.setattr(Rounds, "_next", lambda self, verdict, draft: None)
    monkeypatch.setattr(rounds, "dispensable_joints", lambda *asked: None)
    monkeypatch.setattr(rounds, "first_plan", lambda *asked: Plan())
    monkeypatch.setattr(rounds, "close_seen", lambda drawn: drawn)
    stages = SimpleNamespace(config=replace(BuildConfig(), hulls=HullsConfig(most=MOST)))
    return Rounds(None, None, Path(), None, stages).drafted(), aims


@pytest.mark.parametrize(
    ("made", "asked", "count", "before"),
    [
        # What cutting adds is asked for less.
        ({"cut_off": 30}, [None, MOST, MOST - 30], MOST, 180),
        ({"cut_off": -50}, [None], MOST, None),
        # What passes with more only keeps more.
        ({"cut_off": 30, "refused_below": 120}, [None, MOST, MOST - 30], 130, 180),
        # Where cutting makes more than may be, the least is kept.
        ({"cut_off": 120}, [None, MOST], 220, 270),
        # What becomes heavier by joining stays as it was.
        ({"cut_off": 30, "fat": 90}, [None, MOST], 180, None),
    ],
)
def test_hulls_are_joined_to_as_many_as_may_be(monkeypatch, made, asked, count, before):
    draft, aims = drafted(monkeypatch, **made)
    assert aims == asked
    assert draft.asset.hull_count == count
    assert getattr(draft.before, "hull_count", None) == before


OPEN = np.radians(60.0)


def drawn_open():
    """Return an asset whose door is closed, and its hypothesis, in which it stands open."""
    asset = cabinet(upper=1.5)
    asset = replace(asset, articulation=proposed_by(Proposer.DETECTOR, asset.articulation))
    (joint,) = asset.articulation.joints
    ajar = (replace(joint, lower=-OPEN, upper=1.5 - OPEN),)
    return asset, left_open(asset, replace(asset.articulation, joints=ajar)).articulation


def proposed_by(proposer, articulation):
    """Return an articulation whose door somebody proposed."""
    base, door = articulation.parts
    parts = (base, replace(door, source=PartSource("id", proposer)))
    return replace(articulation, parts=parts)


def test_a_hinge_that_the_detector_sees_is_closed_and_nobody_elses():
    asset, drawn = drawn_open()
    closed = close_seen(drawn)
    assert closed.mesh.bounds == pytest.approx(asset.articulation.mesh.bounds)
    assert (closed.joints[0].lower, closed.joints[0].upper) == pytest.approx((0.0, 1.5))
    for other in (proposed_by(Proposer.RULES, drawn), proposed_by(Proposer.SIDECAR, drawn)):
        assert close_seen(other) is other
    assert close_seen(closed) is closed


def test_the_asset_is_left_as_drawn_with_all_that_its_door_has():
    asset, drawn = drawn_open()
    made = left_open(asset, drawn)
    (joint,) = made.articulation.joints
    assert (joint.lower, joint.upper) == pytest.approx((-OPEN, 1.5 - OPEN))
    assert made.articulation.mesh.bounds == pytest.approx(drawn.mesh.bounds)
    turn = rotation_about(joint.axis, OPEN)
    before, after = asset.bodies[joint.child], made.bodies[joint.child]
    for old, new in zip(before.hulls, after.hulls, strict=True):
        assert new.vertices == pytest.approx((old.vertices - joint.origin) @ turn.T + joint.origin)
        assert new.volume == pytest.approx(old.volume)
    arm = before.inertial.center - joint.origin
    assert after.inertial.center == pytest.approx(turn @ arm + joint.origin)
    assert after.inertial.tensor == pytest.approx(turn @ before.inertial.tensor @ turn.T)
    assert made.bodies[0].hulls[0].vertices == pytest.approx(asset.bodies[0].hulls[0].vertices)
    assert left_open(asset, asset.articulation) is asset


def test_a_hinge_that_a_repair_shortened_opens_as_far_as_it_goes():
    asset, drawn = drawn_open()
    (joint,) = asset.articulation.joints
    short = replace(asset.articulation, joints=(replace(joint, upper=0.4),))
    made = left_open(replace(asset, articulation=short), drawn)
    assert made.articulation.joints[0].lower == pytest.approx(-0.4)
    assert made.articulation.joints[0].upper == pytest.approx(0.0)


@pytest.mark.parametrize(
    ("inspected", "simulated", "kept"),
    [(None, None, True), (None, "jammed", False), ("penetrates", None, False)],
)
def test_only_what_passes_as_drawn_too_is_left_so(inspected, simulated, kept, monkeypatch):
    asset, drawn = drawn_open()
    first = SimpleNamespace(reason=None)
    closed = HypothesisDraft(drawn, asset, None, Plan(), (), first, before=asset)
    again = SimpleNamespace(reason=inspected)
    drafted = partial(replace, closed, inspected=again)
    monkeypatch.setattr(Rounds, "_exported", lambda self, made, *rest: drafted(asset=made))
    said = SimpleNamespace(reason=simulated)
    monkeypatch.setattr(Rounds, "_validated", lambda self, draft, others: said)
    made, verdict = Rounds(drawn, None, Path(), None, None)._as_drawn(closed, first, ())
    assert verdict is (said if kept else first)
    wanted = drawn if kept else asset.articulation
    for shown in (made.asset, made.before):
        assert shown.articulation.mesh.bounds == pytest.approx(wanted.mesh.bounds)


def kept_of(reading, made, measured):
    """What the report tells of an asset, measured so."""
    verdict = Verdict(Report("asset.urdf", measurements={"asset.urdf": measured}))
    return with_kept(verdict, reading, made).report.measurements[KEPT]


def test_ranges_and_coverage_are_shares_of_what_was_read():
    reading = cabinet(upper=1.5).articulation
    shortened = replace(reading, joints=(replace(reading.joints[0], upper=1.2),))
    links = [{"link": "base", "covered": 1.0}, {"link": "door", "covered": 0.9}, {"link": "bare"}]
    kept = kept_of(reading, shortened, {"lint": {"links": links}})
    assert kept == {"range": 0.8, "coverage": 0.95, "worst_coverage": 0.9}


def test_a_frozen_joint_keeps_nothing_and_nothing_measured_is_no_loss():
    reading = cabinet().articulation
    fixed = replace(reading.joints[0], kind=JointKind.FIXED, lower=0.0, upper=0.0)
    assert kept_of(reading, replace(reading, joints=(fixed,)), {})["range"] == 0.0
    assert kept_of(reading, reading, {})["coverage"] == 1.0
