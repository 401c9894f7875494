"""Ranges, axes, drives and resistance of a size that no such object has."""

import math

import pytest
from box_world import body, built, cabinet, linted, turning, with_joint

from asset_factory.sim_checks.report import Report, Severity

ERROR = Severity.ERROR
WARNING = Severity.WARNING
TURNS = 4.0 * math.pi
#: Of the cabinet [m].
ACROSS = math.hypot(0.6, 0.42, 0.8)
#: What a message may say of the cause.
WORDS = ("millimetres", "degrees", "effort", "velocity")


@pytest.mark.parametrize(
    ("name", "changes", "code", "severity", "words"),
    [
        ("slide", {"upper": 1.98 * ACROSS}, "range_implausible", None, []),
        ("slide", {"upper": 2.02 * ACROSS}, "range_implausible", ERROR, []),
        ("slide", {"upper": 300.0}, "range_implausible", ERROR, ["millimetres"]),
        ("slide", {"upper": 1e308}, "range_implausible", ERROR, []),
        ("slide", {"lower": -1e308, "upper": 1e308}, "range_implausible", ERROR, []),
        ("hinge", {"upper": TURNS}, "range_implausible", None, []),
        ("hinge", {"kind": "continuous", "upper": None}, "range_implausible", None, []),
        ("hinge", {"upper": 90.0}, "range_implausible", ERROR, ["degrees"]),
        ("hinge", {"upper": 1e6}, "range_implausible", ERROR, []),
        ("slide", {"upper": 0.0011}, "range_tiny", None, []),
        ("hinge", {"upper": 0.008}, "range_tiny", WARNING, []),
        ("hinge", {"upper": 0.01}, "range_tiny", None, []),
        ("slide", {"effort": 50.0, "velocity": 2.0}, "invalid_effort", None, []),
        *(
            ("slide", {word: number}, "invalid_effort", WARNING, [word])
            for word in ("effort", "velocity")
            for number in (0.0, -1.0, float("nan"))
        ),
    ],
)
def test_a_range_or_a_drive_of_no_such_object_is_told(name, changes, code, severity, words):
    found = linted(with_joint(cabinet(), name, **changes), code)
    assert [(item.joint, item.severity) for item in found] == ([(name, severity)] * bool(severity))
    assert [word for item in found for word in WORDS if word in item.message] == words
    assert Report("x", (), tuple(found)).to_json()


@pytest.mark.parametrize(
    ("name", "upper", "limit"), [("slide", 300.0, 2.0 * ACROSS), ("hinge", 90.0, TURNS)]
)
def test_a_range_is_told_with_the_longest_that_is_fair(name, upper, limit):
    (found,) = linted(with_joint(cabinet(), name, upper=upper), "range_implausible")
    assert (found.value, found.limit) == (upper, pytest.approx(limit, rel=1e-5))


def hinged(distance):
    """A 0.4 x 0.3 x 0.02 m flap beside a cube, hinged at its edge or ``distance`` [m] off both."""
    base = body("base", [((0.3, 0.0, 0.0), (0.2, 0.2, 0.2))])
    flap = [((-0.2, 0.0, 0.0), (0.4, 0.3, 0.02))]
    return built(turning("flap", flap, (0.0, distance + 0.15, 0.0), (1, 0, 0), 1.0), base=base)


def arm():
    """What reaches 3 m from its hinge on the base."""
    tip = turning("tip", [((3, 0, 0), [0.1] * 3)], (0.0, 0.0, 0.0), (0, 0, 1), 1.0)
    return built(tip, base=body("base", [((0, 0, 0), [0.2] * 3)]))


def lamp(gap):
    """A 0.2 m cube that turns on the spot, ``gap`` [m] beside a 0.4 x 0.3 x 0.02 m shelf."""
    cube = [((gap + 0.1, 0.0, 0.0), (0.2, 0.2, 0.2))]
    shelf = body("base", [((-0.2, 0.0, 0.0), (0.4, 0.3, 0.02))])
    return built(turning("lamp", cube, (gap, 0.0, 0.0), (0, 0, 1), 1.0), base=shelf)


REACH = 0.5
#: Damping [N m s/rad] by which a pull of 1 N at the edge opens the door in three seconds.
PER_NEWTON = REACH / 0.5
#: Damping that stops a door of 2 kg, whose axis is its edge, in one step.
STIFF = 240.0 * 2.0 * (REACH**2 / 3.0 + 1e-6 / 12.0)


def door(**resistance):
    """A thin door 0.5 m wide that turns by 1.5 rad, hinged at its edge."""
    panel = [((REACH / 2, 0.0, 0.0), (REACH, 1e-3, 1.0))]
    leaf = turning("door", panel, (0.0, 0.0, 0.0), (0, 0, 1), 1.5, **resistance)
    return built(leaf, base=body("base", [((-0.1, 0.0, 0.0), (0.1, 0.1, 1.0))]))


@pytest.mark.parametrize(
    ("thing", "code", "severity", "value"),
    [
        (hinged(0.0), "axis_remote", None, None),
        # The flap is 0.5 m across, the cube is farther from the axis.
        (hinged(0.45), "axis_remote", None, None),
        (hinged(0.55), "axis_remote", WARNING, 0.55),
        (hinged(1.1), "axis_remote", ERROR, 1.1),
        (arm(), "axis_remote", None, None),
        # A slide has no axis that could be far.
        (with_joint(hinged(2.0), "flap", kind="prismatic"), "axis_remote", None, None),
        (lamp(0.0), "part_remote", None, None),
        (lamp(0.49), "part_remote", None, None),
        (lamp(0.51), "part_remote", ERROR, 0.51),
        (door(friction=29.0 * REACH), "friction_excessive", None, None),
        (door(friction=31.0 * REACH), "friction_excessive", WARNING, 31.0),
        (door(friction=101.0 * REACH), "friction_excessive", ERROR, 101.0),
        # A slide needs no lever.
        (with_joint(cabinet(), "slide", friction=1e4), "friction_excessive", ERROR, 1e4),
        (door(damping=29.0 * PER_NEWTON), "damping_excessive", None, None),
        (door(damping=31.0 * PER_NEWTON), "damping_excessive", WARNING, 31.0),
        (door(damping=101.0 * PER_NEWTON), "damping_excessive", ERROR, 101.0),
        (door(damping=0.9 * STIFF), "damping_stiff", None, None),
        (door(damping=1.1 * STIFF), "damping_stiff", WARNING, 1.1),
    ],
)
def test_an_axis_a_part_or_resistance_out_of_all_proportion_is_told(thing, code, severity, value):
    found = [(item.severity, item.value) for item in linted(thing, code)]
    assert found == ([(severity, pytest.approx(value, rel=1e-5))] if severity else [])


def test_a_part_may_be_as_far_off_as_the_larger_is_across():
    (found,) = linted(lamp(0.51), "part_remote")
    assert found.limit == pytest.approx(math.hypot(0.4, 0.3, 0.02), abs=1e-6)
