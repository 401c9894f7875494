"""Two joints open at once are followed continuously, and only where they can meet."""

import re
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from box_world import box_hull, built, cabinet, penetrating, sliding, turning, with_joint

from asset_factory.sim_checks.description import Mimic
from asset_factory.sim_checks.geometry.depth import overlap
from asset_factory.sim_checks.geometry.kinematics import rotation_about

check = partial(penetrating, combinations=0)


def crossing(reach=0.3, **changes):
    """A needle slides along x past a thin plate that has slid ``reach`` along y."""
    needle = sliding("needle", [((-0.4, 0.3, 0.0), (0.004, 0.004, 0.004))], (1, 0, 0), 0.8)
    plate = sliding("plate", [((0.1234, 0.0, 0.0), (0.004, 0.02, 0.02))], (0, 1, 0), reach)
    return replace(built(needle, plate), **changes)


def over_drawer(upper):
    """A flap hinged 4 mm above a drawer that comes out 0.4 m below it, shut face to face."""
    return built(
        turning("flap", [((0.0, 0.01, 0.2), (0.5, 0.02, 0.4))], (0, 0, 0), (1, 0, 0), upper),
        sliding("drawer", [((0.0, 0.2, -0.104), (0.5, 0.4, 0.2))], (0, -1, 0), 0.4),
    )


def doors(hinge, center, turn):
    """Two mirrored doors, 2 cm thick and 0.4 m wide, that turn by 2 rad; ``hinge`` on the right."""
    parts = []
    for name, side in (("left", -1.0), ("right", 1.0)):
        at, middle = (np.array(place) * [side, 1.0, 1.0] for place in (hinge, center))
        parts.append(turning(name, [(middle, (0.4, 0.02, 0.4))], at, (0.0, 0.0, turn * side), 2.0))
    return built(*parts)


def test_what_a_spread_of_poses_steps_over_is_found_where_it_is():
    result = check(crossing(), combinations=8)
    assert result.measurements["combinations"] == []
    (found,) = result.findings
    assert (found.code, found.severity) == ("joints_collide", "warning")
    assert (found.joints, set(found.parts)) == (("needle", "plate"), {"needle", "plate"})
    assert "needle at 0.52" in found.message
    assert "plate at 0.3 m" in found.message
    assert "open one at a time" in found.message
    assert found.value == pytest.approx(4.0, rel=0.02)
    (measured,) = result.measurements["neighbours"]
    assert (measured["joint"], measured["open"]) == ("needle", "plate")
    assert measured["at"] == pytest.approx(0.5234, abs=1e-3)
    assert measured["point_m"] == pytest.approx([0.1234, 0.3, 0.0], abs=5e-3)


@pytest.mark.parametrize(
    "description",
    [
        crossing(reach=0.2),
        crossing(excluded=frozenset({frozenset({"needle", "plate"})})),
        with_joint(crossing(), "needle", mimic=Mimic("plate")),
        over_drawer(np.pi / 2),
        # Hinged at their outer front edges, each gets 0.5 mm past the middle on its way.
        doors((0.4, -0.01, 0.0), (0.2, 0.0, 0.0), 1.0),
    ],
    ids=["a plate that stops short", "an excluded pair", "one that leads the other",
         "a flap that leaves the drawer its way", "doors that only touch"],
)  # fmt: skip
def test_joints_that_leave_one_another_their_way_are_sound(description):
    result = check(description)
    assert result.findings == ()
    assert result.measurements["neighbours"] == []


def free_until(finding):
    return float(re.findall(r"free until ([\d.]+) ", finding.message)[0])


def test_a_flap_that_drops_a_little_below_its_hinge_ends_the_way_of_the_drawer():
    """The drawer's edge, 4 mm below the hinge, meets the flap where that is as low."""
    (found,) = check(over_drawer(1.6)).findings
    assert (found.code, found.joints) == ("joints_collide", ("drawer", "flap"))
    tilt = 1.6 - np.pi / 2
    touch, deep = 0.004 / np.tan(tilt), (0.004 * np.cos(tilt) + 0.001) / np.sin(tilt)
    assert touch - 0.4 / 100 < free_until(found) <= deep


def test_a_flap_that_a_drawer_stops_once_a_tenth_out_is_an_error():
    result = check(over_drawer(2.2))
    (found,) = result.findings
    assert (found.code, found.severity) == ("joint_obstructed", "error")
    assert found.joints == ("flap", "drawer")
    assert "with drawer at 0.04 m" in found.message
    touch = np.pi / 2 + np.arctan2(0.004, 0.04)
    deep = touch + np.arcsin(0.001 / np.hypot(0.004, 0.04))
    assert touch - 2.2 / 100 < free_until(found) <= deep
    ends = [each["free_until"] for each in result.measurements["neighbours"]]
    assert ends == [pytest.approx(free_until(found), abs=1e-3)]


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
    assert (found.code, found.joints) == ("joints_collide", ("left", "right"))
    assert found.value == pytest.approx(1000 * deepest, rel=0.05)
    (measured,) = result.measurements["neighbours"]
    there = overlap(hull(-1.0, measured["at"]), hull(1.0, measured["open_at"])).depth
    assert found.value == pytest.approx(1000 * there, rel=1e-3)


def test_work_on_joints_together_is_bounded_and_told():
    (found,) = check(crossing(), pair_looks=5).findings
    assert (found.code, found.severity) == ("joints_not_swept", "note")
    assert "1 of 1 pairs" in found.message
    assert "needle with plate" in found.message


def test_a_joint_and_what_it_carries_are_not_neighbours():
    arm = turning("arm", [((0.0, 0.0, 0.0), (0.2, 0.02, 0.02))], (0, 0, 0), (0, 0, 1), 1.0)
    hand = sliding("hand", [((0.15, 0.0, 0.0), (0.05, 0.02, 0.02))], (-1, 0, 0), 0.1, "arm")
    result = check(built(arm, hand))
    assert result.measurements["neighbours"] == []
    assert {finding.joint for finding in result.findings} == {"hand"}


def test_an_overlap_that_was_there_at_rest_is_no_news():
    """Drawer and door overlap by 8 mm when closed: opening one beside the other adds nothing."""
    result = check(cabinet("sib"))
    (met,) = (each for each in result.measurements["rest"] if each["depth_mm"] > 1.0)
    assert met["point_m"] == pytest.approx([0.0, -0.211, 0.394], abs=1e-6), "where they rest"
    assert [item for item in result.measurements["neighbours"] if item["excess_mm"] > 0.0] == []
