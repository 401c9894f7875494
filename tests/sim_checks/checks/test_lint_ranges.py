"""Ranges, axes, drives and resistance of a size that no such object has."""

import math
from dataclasses import replace

import numpy as np
import pytest
from box_world import body, cabinet, described, joint, with_joint

from asset_factory.sim_checks.checks.lint import check_lint
from asset_factory.sim_checks.config import LintConfig
from asset_factory.sim_checks.report import Report, Severity


def finding(description, code):
    return next((f for f in check_lint(description, LintConfig()).findings if f.code == code), None)


def hinged(distance, rest=0.0):
    """A 0.4 x 0.3 x 0.02 m flap beside a cube, hinged at its edge or ``distance`` [m] off both."""
    links = [
        body("base", [((0.3 - rest, 0.0, 0.0), (0.2, 0.2, 0.2))]),
        body("flap", [((-0.2, 0.0, 0.0), (0.4, 0.3, 0.02))], (0.0, distance + 0.15, 0.0)),
    ]
    hinge = joint("hinge", "revolute", "base", "flap", (0, distance + 0.15, 0), (1, 0, 0), (0, 1))
    return described(links, [hinge])


@pytest.mark.parametrize(
    ("upper", "reason"),
    [(3.0, ""), (300.0, "millimetres"), (1e9, ""), (1e308, "")],
    ids=["3 m", "300 m", "far", "off"],
)
def test_a_drawer_that_leaves_for_good_is_refused(upper, reason):
    found = finding(with_joint(cabinet(), "slide", upper=upper), "range_implausible")
    assert (found.severity, found.joint, found.value) == (Severity.ERROR, "slide", upper)
    assert ("millimetres" in found.message) == bool(reason)


def test_limits_whose_difference_is_no_number_can_be_told():
    result = check_lint(with_joint(cabinet(), "slide", lower=-1e308, upper=1e308), LintConfig())
    assert "range_implausible" in Report("x", (), result.findings).to_json()


def test_the_longest_fair_slide_is_two_diagonals():
    diagonal = float(np.linalg.norm([0.6, 0.422, 0.8]))
    for share, fair in ((1.98, True), (2.02, False)):
        slide = with_joint(cabinet(), "slide", upper=share * diagonal)
        assert (finding(slide, "range_implausible") is None) is fair


@pytest.mark.parametrize(("upper", "reason"), [(90.0, "degrees"), (1e6, "")])
def test_a_door_that_turns_and_turns_is_refused(upper, reason):
    found = finding(with_joint(cabinet(), "hinge", upper=upper), "range_implausible")
    assert found.limit == pytest.approx(4.0 * math.pi, rel=1e-5)
    assert ("degrees" in found.message) == bool(reason)


def test_a_tap_of_two_turns_and_a_wheel_without_end_are_fair():
    assert finding(with_joint(cabinet(), "hinge", upper=4.0 * math.pi), "range_implausible") is None
    endless = with_joint(cabinet(), "hinge", kind="continuous", lower=None, upper=None)
    assert finding(endless, "range_implausible") is None


@pytest.mark.parametrize(
    ("name", "upper", "tiny"),
    [
        ("slide", 1e-5, True),
        ("slide", 0.0011, False),
        ("hinge", 0.008, True),
        ("hinge", 0.01, False),
    ],
)
def test_a_range_that_opens_nothing_is_told(name, upper, tiny):
    found = finding(with_joint(cabinet(), name, upper=upper), "range_tiny")
    assert (found is not None) == tiny
    assert found is None or found.severity is Severity.WARNING


@pytest.mark.parametrize("number", [0.0, -1.0, float("nan")])
@pytest.mark.parametrize("word", ["effort", "velocity"])
def test_a_drive_that_cannot_drive_is_told(word, number):
    found = finding(with_joint(cabinet(), "slide", **{word: number}), "invalid_effort")
    assert (found.severity, found.joint) == (Severity.WARNING, "slide")
    assert word in found.message


def test_a_drive_that_drives_is_fair():
    driven = with_joint(cabinet(), "slide", effort=50.0, velocity=2.0)
    assert finding(driven, "invalid_effort") is None


@pytest.mark.parametrize(
    ("distance", "severity"),
    [(0.0, None), (0.45, None), (0.55, Severity.WARNING), (1.1, Severity.ERROR)],
)
def test_a_hinge_axis_far_from_everything_is_told(distance, severity):
    """The flap is 0.5 m across, the axis lies as far beyond it as told; the cube is farther."""
    found = finding(hinged(distance), "axis_remote")
    assert (found and found.severity) == severity
    assert found is None or found.value == pytest.approx(distance, rel=0.02)


def test_a_long_arm_from_a_hinge_on_the_base_is_fair():
    links = [body("base", [((0, 0, 0), [0.2] * 3)]), body("tip", [((3, 0, 0), [0.1] * 3)])]
    hinge = joint("hinge", "revolute", "base", "tip", (0, 0, 0), (0, 0, 1), (0.0, 1.0))
    assert finding(described(links, [hinge]), "axis_remote") is None


def test_a_slide_has_no_axis_that_could_be_far():
    assert finding(with_joint(hinged(2.0), "hinge", kind="prismatic"), "axis_remote") is None


def lamp(gap):
    """A 0.2 m cube that turns on the spot, ``gap`` [m] beside a 0.4 x 0.3 x 0.02 m shelf."""
    links = [
        body("shelf", [((-0.2, 0.0, 0.0), (0.4, 0.3, 0.02))]),
        body("lamp", [((gap + 0.1, 0.0, 0.0), (0.2, 0.2, 0.2))], (gap, 0.0, 0.0)),
    ]
    return described(
        links, [joint("turn", "revolute", "shelf", "lamp", (gap, 0.0, 0.0), (0, 0, 1), (0.0, 1.0))]
    )


@pytest.mark.parametrize(("gap", "told"), [(0.0, False), (0.49, False), (0.51, True), (30.0, True)])
def test_a_part_further_off_than_the_larger_is_across_is_no_part(gap, told):
    found = finding(lamp(gap), "part_remote")
    assert (found is not None) is told
    if found is not None:
        assert found.severity is Severity.ERROR
        assert found.value == pytest.approx(gap)
        assert found.limit == pytest.approx(math.hypot(0.4, 0.3, 0.02), abs=1e-6)


REACH = 0.5


def door(friction=0.0, damping=0.0):
    """A thin door 0.5 m wide that turns by 1.5 rad, hinged at its edge."""
    links = [
        body("frame", [((-0.1, 0.0, 0.0), (0.1, 0.1, 1.0))]),
        body("door", [((REACH / 2, 0.0, 0.0), (REACH, 1e-3, 1.0))]),
    ]
    hinge = joint("hinge", "revolute", "frame", "door", (0.0, 0.0, 0.0), (0, 0, 1), (0.0, 1.5))
    return described(links, [replace(hinge, friction=friction, damping=damping)])


#: Pull [N] at the edge by which a damping [N m s/rad] opens the door in three seconds.
DAMPING = REACH / 0.5


@pytest.mark.parametrize(("word", "per_newton"), [("friction", REACH), ("damping", DAMPING)])
@pytest.mark.parametrize(
    ("force", "severity"), [(29.0, None), (31.0, Severity.WARNING), (101.0, Severity.ERROR)]
)
def test_resistance_counts_as_the_pull_at_the_far_edge(word, per_newton, force, severity):
    found = finding(door(**{word: force * per_newton}), f"{word}_excessive")
    assert (found and found.severity) == severity
    assert found is None or found.value == pytest.approx(force, rel=1e-3)


def test_a_slide_needs_no_lever():
    links = [body("frame", [((0, 0, 0), (0.1,) * 3)]), body("drawer", [((0, 0.2, 0), (0.1,) * 3)])]
    slide = joint("slide", "prismatic", "frame", "drawer", (0.0, 0.0, 0.0), (0, 1, 0), (0.0, 0.3))
    found = finding(described(links, [replace(slide, friction=1e4)]), "friction_excessive")
    assert (found.value, found.severity) == (1e4, Severity.ERROR)


@pytest.mark.parametrize(("share", "told"), [(0.9, False), (1.1, True)])
def test_damping_that_turns_the_speed_round_in_one_step_is_told(share, told):
    thing = door()
    inertia = thing.links[1].inertia
    about_hinge = inertia.tensor[2, 2] + inertia.mass * (REACH / 2) ** 2
    found = finding(door(damping=share * about_hinge * 240.0), "damping_stiff")
    assert (found is not None) is told
    if found is not None:
        assert found.value == pytest.approx(share, rel=1e-4)
