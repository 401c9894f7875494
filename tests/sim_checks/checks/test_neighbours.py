"""Two joints open at once are followed continuously, and only where they can meet."""

from dataclasses import replace

import pytest
from box_world import body, cabinet, described, joint, with_joint

from asset_factory.sim_checks.checks.penetration import check_penetration
from asset_factory.sim_checks.config import PenetrationConfig
from asset_factory.sim_checks.description import Mimic
from asset_factory.sim_checks.report import Severity

BASE = body("base", [((0.0, 0.0, -1.0), (2.0, 2.0, 0.1))])


def crossing(reach=0.3, width=0.004):
    """A needle slides along x past a thin plate that has slid ``reach`` along y."""
    needle = body("needle", [((-0.4, 0.3, 0.0), (0.004, 0.004, 0.004))])
    plate = body("plate", [((0.1234, 0.0, 0.0), (width, 0.02, 0.02))])
    joints = [
        joint("across", "prismatic", "base", "needle", (0, 0, 0), (1.0, 0.0, 0.0), (0.0, 0.8)),
        joint("along", "prismatic", "base", "plate", (0, 0, 0), (0.0, 1.0, 0.0), (0.0, reach)),
    ]
    return described([BASE, needle, plate], joints)


def check(description, combinations=0):
    return check_penetration(description, PenetrationConfig(combinations=combinations))


def test_what_a_spread_of_poses_steps_over_is_found_where_it_is():
    result = check(crossing(), combinations=8)
    assert result.measurements["combinations"] == []
    (found,) = result.findings
    assert (found.code, found.severity, set(found.parts)) == (
        "combination_penetration",
        Severity.SOFT,
        {"needle", "plate"},
    )
    assert "across" in found.message
    assert "along" in found.message
    assert found.value == pytest.approx(4.0, rel=0.02)
    (measured,) = result.measurements["neighbours"]
    assert (measured["joint"], measured["open"]) == ("across", "along")
    assert measured["at"] == pytest.approx(0.5234, abs=1e-3)
    assert measured["point_m"] == pytest.approx([0.1234, 0.3, 0.0], abs=5e-3)


def test_a_plate_that_stops_short_is_not_in_the_way():
    result = check(crossing(reach=0.2))
    assert result.findings == ()
    assert result.measurements["neighbours"] == []


def test_joints_that_lead_one_another_are_never_open_apart():
    led = with_joint(crossing(), "across", mimic=Mimic("along"))
    assert check(led).measurements["neighbours"] == []


def test_a_joint_and_what_it_carries_are_not_neighbours():
    arm = body("arm", [((0.0, 0.0, 0.0), (0.2, 0.02, 0.02))])
    hand = body("hand", [((0.15, 0.0, 0.0), (0.05, 0.02, 0.02))])
    joints = [
        joint("shoulder", "revolute", "base", "arm", (0, 0, 0), (0.0, 0.0, 1.0), (0.0, 1.0)),
        joint("wrist", "prismatic", "arm", "hand", (0, 0, 0), (-1.0, 0.0, 0.0), (0.0, 0.1)),
    ]
    result = check(described([BASE, arm, hand], joints))
    assert result.measurements["neighbours"] == []
    assert {finding.joint for finding in result.findings} == {"wrist"}


def test_sound_neighbours_do_not_meet():
    assert check(cabinet()).measurements["neighbours"] == []


def test_an_overlap_that_was_there_at_rest_is_no_news():
    """Drawer and door overlap by 8 mm when closed: opening one beside the other adds nothing."""
    result = check(cabinet("sib"))
    assert [item for item in result.measurements["neighbours"] if item["excess_mm"] > 0.0] == []


def test_excluded_pairs_are_left_out():
    excluded = replace(crossing(), excluded=frozenset({frozenset({"needle", "plate"})}))
    assert check(excluded).findings == ()
