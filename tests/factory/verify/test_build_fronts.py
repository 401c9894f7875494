"""Fronts that stick in something are built anew, once, and only where they were guessed."""

from __future__ import annotations

import numpy as np
from modelled_furniture import drawer_chest

from asset_factory.factory.articulation import Articulation, Joint, JointKind, Part
from asset_factory.factory.config import RepairConfig
from asset_factory.factory.geometry.components import connected_components
from asset_factory.factory.manufacture.plan import Plan, Spare, dispensable_joints
from asset_factory.factory.verify.repair import next_plan
from asset_factory.factory.verify.validate import Verdict
from asset_factory.sim_checks import Finding, Severity
from asset_factory.sim_checks.report import Report

FRONTS = Spare(fronts=frozenset({"drawer"}))


def rejected(code: str) -> Verdict:
    finding = Finding(code, Severity.HARD, "it does", parts=("base", "drawer"))
    return Verdict(Report("asset.urdf", findings=(finding,)))


def drawer(articulator: str) -> Articulation:
    """The upper drawer of a chest, by whoever says so."""
    mesh = drawer_chest()
    own = np.isin(connected_components(mesh), (2, 4))
    parts = (Part("base", np.flatnonzero(~own)), Part("drawer", np.flatnonzero(own)))
    out = np.array([0.0, -1.0, 0.0])
    joint = Joint("slide", JointKind.PRISMATIC, 0, 1, out, np.zeros(3), upper=0.3)
    return Articulation(mesh, parts, (joint,), articulator)


def test_a_front_that_sticks_is_built_anew_once() -> None:
    plan = next_plan(rejected("rest_penetration"), Plan(), RepairConfig(), FRONTS)
    assert plan is not None
    assert plan.build_fronts
    assert plan.steps == ("built fronts and body anew: drawer",)
    assert next_plan(rejected("rest_penetration"), plan, RepairConfig(), FRONTS) is None


def test_nothing_is_built_for_other_faults_or_without_fronts() -> None:
    assert next_plan(rejected("no_mass"), Plan(), RepairConfig(), FRONTS) is None
    assert next_plan(rejected("rest_penetration"), Plan(), RepairConfig(), Spare()) is None


def test_only_guessed_fronts_are_built() -> None:
    assert dispensable_joints(drawer("auto"), 0.1).fronts == {"drawer"}
    assert not dispensable_joints(drawer("annotated"), 0.1).fronts
