"""Joints that no hand opens, and damping that no explicit engine survives."""

from dataclasses import replace

import pytest
from box_world import body, described, joint

from asset_factory.sim_checks.checks.lint import check_lint
from asset_factory.sim_checks.config import LintConfig
from asset_factory.sim_checks.report import Severity

REACH = 0.5


def finding(description, code):
    return next(
        (item for item in check_lint(description, LintConfig()).findings if item.code == code), None
    )


def door(friction=0.0, damping=0.0):
    """A thin door 0.5 m wide that turns by 1.5 rad, hinged at its edge."""
    links = [
        body("frame", [((-0.1, 0.0, 0.0), (0.1, 0.1, 1.0))]),
        body("door", [((REACH / 2, 0.0, 0.0), (REACH, 1e-3, 1.0))]),
    ]
    hinge = joint("hinge", "revolute", "frame", "door", (0.0, 0.0, 0.0), (0, 0, 1), (0.0, 1.5))
    return described(links, [replace(hinge, friction=friction, damping=damping)])


@pytest.mark.parametrize(
    ("force", "severity"), [(29.0, None), (31.0, Severity.WARNING), (101.0, Severity.ERROR)]
)
def test_friction_counts_as_the_pull_at_the_far_edge(force, severity):
    found = finding(door(friction=force * REACH), "friction_excessive")
    assert (None if found is None else found.severity) == severity
    if found is not None:
        assert found.value == pytest.approx(force, rel=1e-3)


@pytest.mark.parametrize(
    ("force", "severity"), [(29.0, None), (31.0, Severity.WARNING), (101.0, Severity.ERROR)]
)
def test_damping_counts_as_the_pull_that_opens_it_in_three_seconds(force, severity):
    found = finding(door(damping=force * REACH / 0.5), "damping_excessive")
    assert (None if found is None else found.severity) == severity


def test_a_slide_needs_no_lever():
    links = [
        body("frame", [((0.0, 0.0, 0.0), (0.1,) * 3)]),
        body("drawer", [((0.0, 0.2, 0.0), (0.1,) * 3)]),
    ]
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
