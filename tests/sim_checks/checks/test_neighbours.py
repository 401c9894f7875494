"""Two joints open at once are followed continuously, and only where they can meet."""

import re
from dataclasses import replace

import numpy as np
import pytest
from box_world import body, box_hull, cabinet, described, joint, with_joint

from asset_factory.sim_checks.checks.penetration import check_penetration
from asset_factory.sim_checks.config import PenetrationConfig
from asset_factory.sim_checks.description import Mimic
from asset_factory.sim_checks.geometry.depth import overlap
from asset_factory.sim_checks.geometry.kinematics import rotation_about
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
        "joints_collide",
        Severity.WARNING,
        {"needle", "plate"},
    )
    assert found.joints == ("across", "along")
    assert "across at 0.52" in found.message
    assert "along at 0.3 m" in found.message
    assert "open one at a time" in found.message
    assert found.value == pytest.approx(4.0, rel=0.02)
    (measured,) = result.measurements["neighbours"]
    assert (measured["joint"], measured["open"]) == ("across", "along")
    assert measured["at"] == pytest.approx(0.5234, abs=1e-3)
    assert measured["point_m"] == pytest.approx([0.1234, 0.3, 0.0], abs=5e-3)


def test_a_plate_that_stops_short_is_not_in_the_way():
    result = check(crossing(reach=0.2))
    assert result.findings == ()
    assert result.measurements["neighbours"] == []


def over_drawer(upper, gap=0.004):
    """A flap hinged ``gap`` above a drawer that comes out 0.4 m below it, shut face to face."""
    flap = body("flap", [((0.0, 0.01, 0.2), (0.5, 0.02, 0.4))])
    drawer = body("drawer", [((0.0, 0.2, -0.1 - gap), (0.5, 0.4, 0.2))])
    joints = [
        joint("drop", "revolute", "base", "flap", (0, 0, 0), (1.0, 0.0, 0.0), (0.0, upper)),
        joint("slide", "prismatic", "base", "drawer", (0, 0, 0), (0.0, -1.0, 0.0), (0.0, 0.4)),
    ]
    return described([BASE, flap, drawer], joints)


def test_a_flap_that_opens_over_a_drawer_leaves_it_its_way():
    assert check(over_drawer(np.pi / 2)).findings == ()


def test_a_flap_that_drops_a_little_below_its_hinge_ends_the_way_of_the_drawer():
    """The drawer's edge, 4 mm below the hinge, meets the flap where that is as low."""
    (found,) = check(over_drawer(1.6)).findings
    assert (found.code, found.joints) == ("joints_collide", ("slide", "drop"))
    tilt = 1.6 - np.pi / 2
    touch, deep = 0.004 / np.tan(tilt), (0.004 * np.cos(tilt) + 0.001) / np.sin(tilt)
    assert touch - 0.4 / 100 < _free_until(found) <= deep


def test_a_flap_that_a_drawer_stops_once_a_tenth_out_is_an_error():
    (found,) = check(over_drawer(2.2)).findings
    assert (found.code, found.severity) == ("joint_obstructed", "error")
    assert found.joints == ("drop", "slide")
    assert "with slide at 0.04 m" in found.message
    touch = np.pi / 2 + np.arctan2(0.004, 0.04)
    deep = touch + np.arcsin(0.001 / np.hypot(0.004, 0.04))
    assert touch - 2.2 / 100 < _free_until(found) <= deep


def _free_until(finding):
    return float(re.findall(r"free until ([\d.]+) ", finding.message)[0])


def doors(hinge, center, turn):
    """Two mirrored doors, 2 cm thick and 0.4 m wide, that turn by 2 rad; ``hinge`` on the right."""
    links = [BASE]
    joints = []
    for name, side in (("left", -1.0), ("right", 1.0)):
        at, middle = (np.array(place) * [side, 1.0, 1.0] for place in (hinge, center))
        links.append(body(name, [(middle, (0.4, 0.02, 0.4))], at))
        axis = (0.0, 0.0, turn * side)
        joints.append(joint(f"{name}_hinge", "revolute", "base", name, at, axis, (0.0, 2.0)))
    return described(links, joints)


def test_doors_that_only_touch_in_the_middle_of_a_cabinet_are_sound():
    """Hinged at their outer front edges, each gets 0.5 mm past the middle on its way."""
    assert check(doors((0.4, -0.01, 0.0), (0.2, 0.0, 0.0), 1.0)).findings == ()


def test_doors_that_pass_the_plane_between_their_hinges_are_found_where_they_are_deepest():
    """Both are hinged 3 cm beside the middle and turn by 2 rad; every pose of both is tried."""

    def hull(side, angle):
        turned = rotation_about(np.array([0.0, 0.0, -side]), angle)
        center = turned @ [0.2 * side, 0.0, 0.0] + [0.03 * side, 0.0, 0.0]
        return box_hull(center, (0.4, 0.02, 0.4), turned)

    poses = np.linspace(0.0, 2.0, 41)
    lefts, rights = ([hull(side, angle) for angle in poses] for side in (-1.0, 1.0))
    deepest = max(overlap(left, right).depth for left in lefts for right in rights)
    result = check(doors((0.03, 0.0, 0.0), (0.23, 0.0, 0.0), -1.0))
    (found,) = result.findings
    assert (found.code, found.joints) == ("joints_collide", ("left_hinge", "right_hinge"))
    assert found.value == pytest.approx(1000 * deepest, rel=0.05)
    (measured,) = result.measurements["neighbours"]
    there = overlap(hull(-1.0, measured["at"]), hull(1.0, measured["open_at"])).depth
    assert found.value == pytest.approx(1000 * there, rel=1e-3)


def test_work_on_joints_together_is_bounded_and_told():
    bounded = check_penetration(crossing(), PenetrationConfig(combinations=0, pair_looks=5))
    (found,) = bounded.findings
    assert (found.code, found.severity) == ("joints_not_swept", "note")
    assert "1 of 1 pairs" in found.message
    assert "across with along" in found.message


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


def test_an_overlap_that_was_there_at_rest_is_no_news():
    """Drawer and door overlap by 8 mm when closed: opening one beside the other adds nothing."""
    result = check(cabinet("sib"))
    (met,) = (each for each in result.measurements["rest"] if each["depth_mm"] > 1.0)
    assert met["point_m"] == pytest.approx([0.0, -0.211, 0.394], abs=1e-6), "where they rest"
    assert [item for item in result.measurements["neighbours"] if item["excess_mm"] > 0.0] == []


def test_excluded_pairs_are_left_out():
    excluded = replace(crossing(), excluded=frozenset({frozenset({"needle", "plate"})}))
    assert check(excluded).findings == ()
