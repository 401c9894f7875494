"""Penetration at rest and along joints: each fault has its code, sound furniture none."""

from dataclasses import replace

import numpy as np
import pytest
from box_world import body, built, cabinet, described, joint, penetrating, sliding, with_joint
from small_cabinet import codes, rows

from asset_factory.sim_checks.checks.penetration import combination_values

UNIT = (1.0, 1.0, 1.0)


def test_two_joints_are_looked_at_with_both_open():
    assert combination_values({"a": (0.0, 1.0), "b": (-1.0, 2.0)}, 0) == [{"a": 1.0, "b": 2.0}]


def test_three_joints_that_run_parts_into_each_other_only_together_are_told():
    """A block that goes up and then aside meets one that comes down to beside it."""
    size = (0.1, 0.1, 0.1)
    lift = sliding("lift", [((0.0, 1.0, 0.0), size)], (0, 0, 1), 0.5)
    arm = sliding("arm", [((0.0, 0.0, 0.0), size)], (1, 0, 0), 0.5, "lift")
    lid = sliding("lid", [((0.5, 0.0, 1.0), size)], (0, 0, -1), 0.44)
    result = penetrating(built(lift, arm, lid))
    (found,) = result.findings
    assert (found.code, found.severity) == ("combination_penetration", "warning")
    assert (set(found.parts), found.value) == ({"arm", "lid"}, pytest.approx(40.0))
    assert "when lift=0.5, arm=0.5, lid=0.44" in found.message
    (measured,) = result.measurements["combinations"]
    assert measured["values"] == {"lift": 0.5, "arm": 0.5, "lid": 0.44}


def test_an_excluded_pair_excuses_no_other_pair_of_its_links():
    excluded = frozenset({frozenset({"carcass", "door"}), frozenset({"drawer", "door"})})
    assert "rest_penetration" in codes(penetrating(replace(cabinet("wide"), excluded=excluded)))


def test_links_joined_rigidly_are_one_body():
    links = [body(name, [((0.0, 0.0, z), UNIT)]) for name, z in (("base", 0.0), ("plinth", -0.4))]
    weld = joint("weld", "fixed", "base", "plinth", (0, 0, 0), (1.0, 0.0, 0.0), None)
    result = penetrating(described(links, [weld]))
    assert result.findings == ()
    assert result.measurements["parts"] == [["base", "plinth"]]


def test_the_pose_a_file_was_drawn_in_counts_too():
    """Rest is where the joint is at lower; a simulator starts at 0."""
    slider = sliding("slider", [((0.99, 0.0, 0.0), UNIT)], (-1.0, 0.0, 0.0), 0.0)
    slid = built(slider, base=body("base", [((0.0, 0.0, 0.0), UNIT)]))
    findings = penetrating(with_joint(slid, "slider", lower=-0.2)).findings
    (found,) = (item for item in findings if item.code == "rest_penetration")
    assert (found.value, found.severity) == (pytest.approx(10.0), "error")
    assert "at 0" in found.message


def test_a_continuous_joint_is_swept_over_a_whole_turn():
    base = body("base", [((-0.5, 0.0, 0.0), (0.02, 0.02, 0.02))])
    arm = body("arm", [((0.3, 0.0, 0.0), (0.4, 0.01, 0.01))])
    spin = joint("spin", "continuous", "base", "arm", (0, 0, 0), (0.0, 0.0, 1.0), None)
    result = penetrating(described([base, arm], [spin]))
    assert rows(result)["spin"]["pairs"][0]["at"] == pytest.approx(np.pi, abs=0.05)
    assert [finding.code for finding in result.findings] == ["sweep_penetration"]


def test_turning_the_joint_around_finds_the_same_overlap():
    """Lower = closed or upper = closed: what meets, meets."""
    forward = cabinet("hinge_inside")
    backward = with_joint(forward, "hinge", axis=np.array([0.0, 0.0, 1.0]), lower=-1.57, upper=0.0)
    depths = [
        max(pair["depth_mm"] for pair in rows(penetrating(item))["hinge"]["pairs"])
        for item in (forward, backward)
    ]
    assert depths[0] == pytest.approx(depths[1], rel=0.03)
