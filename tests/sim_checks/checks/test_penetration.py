"""Penetration at rest and along joints: each fault has its code, sound furniture none."""

from dataclasses import replace

import numpy as np
import pytest
from box_world import body, cabinet, described, joint, with_joint

from asset_factory.sim_checks.checks.penetration import check_penetration, combination_values
from asset_factory.sim_checks.config import PenetrationConfig
from asset_factory.sim_checks.report import Severity

CONFIG = PenetrationConfig()
BASE = body("base", [((0.0, 0.0, -1.0), (4.0, 4.0, 0.1))])


def check(description):
    return check_penetration(description, CONFIG)


def hard(result):
    return [finding for finding in result.findings if finding.severity is Severity.ERROR]


def codes(result):
    return [finding.code for finding in result.findings]


def sweep_of(result, name):
    return next(item for item in result.measurements["joints"] if item["joint"] == name)


@pytest.mark.parametrize(
    ("defect", "code", "name", "parts", "depth"),
    [
        ("wide", "rest_penetration", None, {"carcass", "drawer"}, 5.0),
        ("long", "rest_penetration", None, {"carcass", "drawer"}, 13.0),
        ("sib", "rest_penetration", None, {"drawer", "door"}, 8.0),
        ("hinge_inside", "sweep_penetration", "hinge", {"carcass", "door"}, 18.0),
    ],
)
def test_each_defect_is_caught_by_its_own_code(defect, code, name, parts, depth):
    found = next(finding for finding in hard(check(cabinet(defect))) if finding.code == code)
    assert (found.joint, set(found.parts), found.unit) == (name, parts, "mm")
    assert found.value == pytest.approx(depth, rel=0.02)


def test_two_joints_are_looked_at_with_both_open():
    ranges = {"a": (0.0, 1.0), "b": (-1.0, 2.0)}
    assert combination_values(ranges, 0) == [{"a": 1.0, "b": 2.0}]


def test_three_joints_that_run_parts_into_each_other_only_together_are_told():
    """A block that goes up and then aside meets one that comes down to beside it."""
    far = ((0.0, 0.0, 0.0), (0.1, 0.1, 0.1))
    links = [BASE, body("lift", [((0.0, 1.0, 0.0), (0.1, 0.1, 0.1))]), body("arm", [far])]
    links.append(body("lid", [((0.5, 0.0, 1.0), (0.1, 0.1, 0.1))]))
    joints = [
        joint("up", "prismatic", "base", "lift", (0, 0, 0), (0, 0, 1), (0.0, 0.5)),
        joint("aside", "prismatic", "lift", "arm", (0, 0, 0), (1, 0, 0), (0.0, 0.5)),
        joint("down", "prismatic", "base", "lid", (0, 0, 0), (0, 0, -1), (0.0, 0.44)),
    ]
    result = check(described(links, joints))
    (found,) = result.findings
    assert (found.code, found.severity) == ("combination_penetration", Severity.WARNING)
    assert set(found.parts) == {"arm", "lid"}
    assert found.value == pytest.approx(40.0)
    assert "when up=0.5, aside=0.5, down=0.44" in found.message
    (measured,) = result.measurements["combinations"]
    assert measured["values"] == {"up": 0.5, "aside": 0.5, "down": 0.44}


def test_an_excluded_pair_excuses_no_other_pair_of_its_links():
    excluded = frozenset({frozenset({"carcass", "door"}), frozenset({"drawer", "door"})})
    description = replace(cabinet("wide"), excluded=excluded)
    assert "rest_penetration" in [finding.code for finding in hard(check(description))]


def test_links_joined_rigidly_are_one_body():
    base = body("base", [((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))])
    plinth = body("plinth", [((0.0, 0.0, -0.4), (1.0, 1.0, 1.0))])
    weld = joint("weld", "fixed", "base", "plinth", (0, 0, 0), (1.0, 0.0, 0.0), None)
    result = check(described([base, plinth], [weld]))
    assert result.findings == ()
    assert result.measurements["parts"] == [["base", "plinth"]]


def test_the_pose_a_file_was_drawn_in_counts_too():
    """Rest is where the joint is at lower; a simulator starts at 0."""
    base = body("base", [((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))])
    slider = body("slider", [((0.99, 0.0, 0.0), (1.0, 1.0, 1.0))])
    slide = joint("slide", "prismatic", "base", "slider", (0, 0, 0), (-1.0, 0.0, 0.0), (-0.2, 0.0))
    result = check(described([base, slider], [slide]))
    found = hard(result)
    assert [each.value for each in found if each.code == "rest_penetration"] == pytest.approx(
        [10.0]
    )
    assert "at 0" in found[0].message


def test_a_continuous_joint_is_swept_over_a_whole_turn():
    base = body("base", [((-0.5, 0.0, 0.0), (0.02, 0.02, 0.02))])
    arm = body("arm", [((0.3, 0.0, 0.0), (0.4, 0.01, 0.01))])
    spin = joint("spin", "continuous", "base", "arm", (0, 0, 0), (0.0, 0.0, 1.0), None)
    result = check(described([base, arm], [spin]))
    assert sweep_of(result, "spin")["pairs"][0]["at"] == pytest.approx(np.pi, abs=0.05)
    assert codes(result) == ["sweep_penetration"]


def test_turning_the_joint_around_finds_the_same_overlap():
    """Lower = closed or upper = closed: what meets, meets."""
    forward = cabinet("hinge_inside")
    backward = with_joint(forward, "hinge", axis=np.array([0.0, 0.0, 1.0]), lower=-1.57, upper=0.0)
    depths = [
        max(pair["depth_mm"] for pair in sweep_of(check(item), "hinge")["pairs"])
        for item in (forward, backward)
    ]
    assert depths[0] == pytest.approx(depths[1], rel=0.03)
