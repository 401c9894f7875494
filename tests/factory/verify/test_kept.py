"""A report tells what share of ranges and surfaces is left."""

from dataclasses import replace

from test_mend import cabinet

from asset_factory.factory.articulation import JointKind
from asset_factory.factory.verify.kept import KEPT, with_kept
from asset_factory.factory.verify.validate import Verdict
from asset_factory.sim_checks import Report


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
    frozen = replace(reading, joints=(fixed,))
    assert kept_of(reading, frozen, {})["range"] == 0.0
    assert kept_of(reading, reading, {})["coverage"] == 1.0
