"""A report tells what share of ranges and surfaces is left."""

from dataclasses import replace
from pathlib import Path

import pytest
from test_mend import cabinet

from asset_factory.factory.articulation import JointKind
from asset_factory.factory.build import build_asset
from asset_factory.factory.config import BuildConfig, HullsConfig
from asset_factory.factory.verify.kept import kept_of
from asset_factory.sim_checks.config import CheckConfig

CABINET = Path(__file__).resolve().parents[3] / "examples" / "meshes" / "cabinet.glb"


def test_ranges_and_coverage_are_shares_of_what_was_read():
    reading = cabinet(upper=1.5).articulation
    shortened = replace(reading, joints=(replace(reading.joints[0], upper=1.2),))
    links = [{"link": "base", "covered": 1.0}, {"link": "door", "covered": 0.9}, {"link": "bare"}]
    kept = kept_of(reading, shortened, {"lint": {"links": links}})
    assert kept.to_dict() == {"range": 0.8, "coverage": 0.95, "worst_coverage": 0.9}


def test_a_frozen_joint_keeps_nothing_and_nothing_measured_is_no_loss():
    reading = cabinet().articulation
    fixed = replace(reading.joints[0], kind=JointKind.FIXED, lower=0.0, upper=0.0)
    frozen = replace(reading, joints=(fixed,))
    assert kept_of(reading, frozen, {}).range == 0.0
    assert kept_of(reading, reading, {}).coverage == pytest.approx(1.0)


def test_a_link_that_its_hulls_leave_bare_rejects_what_is_built(tmp_path):
    # No link has more than all of its surface covered.
    config = replace(BuildConfig(simulators=()), hulls=HullsConfig(least_covered=1.01))
    entry = build_asset(CABINET, tmp_path, config).entry
    assert (entry.status, entry.reason) == ("rejected", "collision_gap")


def test_no_less_is_asked_of_what_is_built_than_of_other_files():
    strict = replace(CheckConfig(), lint=replace(CheckConfig().lint, least_covered=0.99))
    assert BuildConfig().own_checks.lint.least_covered > CheckConfig().lint.least_covered
    assert replace(BuildConfig(), checks=strict).own_checks == strict
