"""Sweeps of known answer: drawers, doors, pins, hinges, nests; and what changes no number."""

import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from fault_corpus.broken_motion import knuckle, screw_in_the_way
from fault_corpus.good_things import cabinet, nested, turned
from fault_corpus.things import (
    Body,
    Move,
    Thing,
    at,
    box,
    moved,
    with_body,
    with_move,
    write_mjcf,
    write_urdf,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from small_cabinet import codes as hard
from small_cabinet import rows

from asset_factory.sim_checks.checks.penetration import check_penetration
from asset_factory.sim_checks.config import PenetrationConfig
from asset_factory.sim_checks.read.read import read_here

CONFIG = PenetrationConfig()
WIDE = PenetrationConfig(clearance_m=0.05)
#: The search is sure of the worst to this [mm], or to 2 % of it.
SURE = 0.02


def judged(thing, config=CONFIG, write=write_urdf):
    with tempfile.TemporaryDirectory() as folder:
        return check_penetration(read_here(write(thing, Path(folder))), config)


def codes(result):
    return [finding.code for finding in result.findings]


def doorway(still, door, axis):
    """A door hinged about an axis through the world's origin, and what stands beside it."""
    bodies = (Body("wall", (still,), at(0, 0, 0), 5.0), Body("door", (door,), at(0, 0, 0), 2.0))
    return Thing("doorway", bodies, (Move("hinge", "revolute", "wall", "door", axis, 0.0, 1.5),))


def tray(side, top, back, travel=0.3):
    """A block in a bay 0.4 wide, 0.3 deep, 0.2 high, with these gaps [m]; 20 mm below it."""
    bay = (
        box((-0.25, 0.15, 0.1), (0.1, 0.5, 0.4)),
        box((0.25, 0.15, 0.1), (0.1, 0.5, 0.4)),
        box((0.0, 0.15, 0.25), (0.6, 0.5, 0.1)),
        box((0.0, 0.15, -0.05), (0.6, 0.5, 0.1)),
        box((0.0, 0.35, 0.1), (0.6, 0.1, 0.4)),
    )
    low = np.array([-0.2 + side, 0.0, 0.02])
    high = np.array([0.2 - side, 0.3 - back, 0.2 - top])
    bodies = (
        Body("bay", bay, at(0, 0, 0), 10.0),
        Body("block", (box((low + high) / 2, high - low),), at(0, 0, 0.1), 1.0),
    )
    slide = Move("slide", "prismatic", "bay", "block", (0.0, -1.0, 0.0), 0.0, travel)
    return Thing("tray", bodies, (slide,))


@pytest.mark.parametrize(
    "gaps",
    [
        (2e-3, 4e-3, 6e-3),
        (9e-3, 1e-4, 1e-3),
        (0.02, 0.015, 3e-4),
        (-5e-3, 4e-3, 6e-3),
        (9e-3, -3e-3, 1e-3),
        (0.02, 0.015, -0.013),
    ],
)
def test_a_drawer_s_narrowest_gap_is_its_clearance_or_its_depth_and_never_counts_as_excess(gaps):
    result = judged(tray(*gaps), WIDE)
    slide = rows(result)["slide"]
    if min(gaps) > 0.0:
        assert result.findings == ()
        assert slide["clearance_mm"] == pytest.approx(1000 * min(gaps), abs=SURE, rel=0.02)
    else:
        (found,) = result.findings
        assert (found.code, found.severity) == ("rest_penetration", "error")
        assert (found.joint, set(found.parts)) == (None, {"bay", "block"})
        assert (found.value, found.unit) == (pytest.approx(-1000 * min(gaps), rel=1e-3), "mm")
        assert slide["excess_mm"] <= SURE


@pytest.mark.parametrize("beyond", [1.1e-3, 5e-3, 0.05])
def test_a_drawer_driven_into_a_post_goes_as_deep_as_its_travel_is_too_long(beyond):
    thing = tray(3e-3, 3e-3, 3e-3, travel=0.2 + beyond)
    post = box((0.0, -0.25, 0.1), (0.1, 0.1, 0.3))
    result = judged(with_body(thing, "bay", pieces=(*thing.bodies[0].pieces, post)))
    assert hard(result) == ["sweep_penetration"]
    assert result.findings[0].value == pytest.approx(1000 * beyond, rel=0.02)
    found = rows(result)["slide"]
    assert found["pairs"][0]["at"] == pytest.approx(0.2 + beyond, abs=2e-5 + 0.02 * beyond)
    # It may go until it is one millimetre in, found by seven halvings, and is never let go too far.
    most = 0.2 + CONFIG.excess_m
    assert most - beyond - (0.2 + beyond) / 2**7 <= found["clear_until"] <= most + 1e-6


@pytest.mark.parametrize("gap", [5e-5, 2e-4, 4e-4])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_door_s_corner_cuts_the_jamb_where_the_circle_says(gap, sign):
    """Hinged at its front edge: its back corner first swings outwards on the diagonal's circle."""
    width = 0.6
    thick = 0.05
    radius = np.hypot(width, thick)
    start = np.arctan2(thick, width)
    jamb = box((width + gap + 0.1, 0.0, 0.0), (0.2, 0.5, 1.0))
    door = box((width / 2, sign * thick / 2, 0.0), (width, thick, 0.9))
    result = judged(doorway(jamb, door, (0.0, 0.0, -sign)))
    worst = radius - width - gap
    found = rows(result)["hinge"]
    assert worst > CONFIG.excess_m
    (told,) = result.findings
    assert (told.code, told.severity) == ("sweep_penetration", "error")
    assert (told.joint, set(told.parts)) == ("hinge", {"wall", "door"})
    assert (told.value, told.unit) == (pytest.approx(1000 * worst, rel=0.02), "mm")
    # Near its top a circle is flat: a depth known to 2 % is a place known to this angle.
    flat = np.sqrt(2.0 * max(2e-5, 0.02 * worst) / radius)
    assert found["pairs"][0]["at"] == pytest.approx(start, abs=flat)
    first, last = (
        start - np.arccos((width + gap + CONFIG.excess_m + more) / radius)
        for more in (0.0, SURE / 1000)
    )
    assert first - start / 2**6 <= found["clear_until"] <= last


@pytest.mark.parametrize("step", [3.5, 31.5, 60.5])
@pytest.mark.parametrize("size", [0.002, 0.0015])
def test_a_pin_that_meets_a_fin_between_two_samples_of_a_slide(step, size):
    """Of 64 poses 4.8 mm apart none sees it: the pin is 2 mm, the fin 1 mm."""
    place = step * 0.3 / 63
    assert abs(place - 0.3 / 63 * round(step)) > (size + 0.001) / 2
    result = judged(screw_in_the_way(place, size))
    assert hard(result) == ["sweep_penetration"]
    # Pin and fin share half of both along the way; across it they share 2 mm.
    deepest = min((size + 0.001) / 2, 0.002)
    assert result.findings[0].value == pytest.approx(1000 * deepest, rel=0.02)
    assert rows(result)["slide"]["pairs"][0]["at"] == pytest.approx(place, abs=1e-4)


@pytest.mark.parametrize("step", [2.5, 17.4, 33.5, 55.6])
def test_a_pin_on_a_door_that_meets_a_thread_between_two_samples_of_a_turn(step):
    arm = 0.5
    angle = step * 1.5 / 63
    size = 0.002
    pin = box((arm, 0.0, 0.0), (size, size, size))
    thread = box((arm * np.cos(angle), arm * np.sin(angle), 0.0), (0.001, 0.001, 1.0))
    # 64 poses are 11.9 mm apart out there.
    assert arm * abs(angle - 1.5 / 63 * round(step)) > 0.003
    result = judged(doorway(thread, pin, (0.0, 0.0, 1.0)))
    assert hard(result) == ["sweep_penetration"]
    # Square in square, turned against one another: between face on face and corner on corner.
    assert 1.5 * 0.98 <= (result.findings[0].value or 0.0) <= 1.5 * np.sqrt(2.0)
    assert rows(result)["hinge"]["pairs"][0]["at"] == pytest.approx(angle, abs=1e-3)


def test_a_knuckle_is_as_deep_as_its_leaves_are_thick():
    (found,) = judged(knuckle(0.05)).findings
    assert (found.code, found.value) == ("hinge_overlap", pytest.approx(12.0, rel=1e-3))
    assert hard(judged(knuckle(0.35))) != []


@pytest.mark.parametrize("beyond", [2e-3, 0.02])
def test_a_tray_in_a_swinging_door_hits_the_back_behind_it_unless_the_door_is_open(beyond):
    # 272 mm from the tray to the back of the carcass.
    result = judged(with_move(nested(), "slide", upper=0.272 + beyond))
    assert hard(result) == []
    (found,) = result.findings
    assert (found.code, found.joint) == ("joint_dependency", "slide")
    assert found.value == pytest.approx(1000 * beyond, rel=0.02)


@pytest.mark.parametrize(
    "thing", [cabinet(), turned(), nested(), screw_in_the_way(), tray(-4e-3, 2e-3, 2e-3)]
)
def test_the_same_thing_gives_the_same_numbers_from_both_formats(thing):
    urdf, mjcf = (judged(thing, WIDE, write) for write in (write_urdf, write_mjcf))
    assert codes(urdf) == codes(mjcf)
    assert numbers(mjcf) == pytest.approx(numbers(urdf), abs=2 * SURE, rel=0.02)


SAMPLES = (
    cabinet(),
    screw_in_the_way(),
    tray(-4e-3, 2e-3, 3e-3),
    with_body(cabinet(), "door", frame=at(-0.27, -4e-3, 0.5)),
    with_move(nested(), "slide", upper=0.29),
)


@settings(max_examples=12)
@given(
    thing=st.sampled_from(SAMPLES),
    seed=st.integers(0, 2**32 - 1),
    shift=st.tuples(*[st.floats(-10.0, 10.0)] * 3),
    power=st.floats(-1.0, 1.0),
)
def test_neither_place_nor_pose_nor_size_changes_the_verdict(thing, seed, shift, power):
    generator = np.random.default_rng(seed)
    scale = 10.0**power
    pose = at(*shift)
    pose[:3, :3] = Rotation.random(random_state=generator).as_matrix()
    other = moved(thing, pose, scale)
    other = replace(other, bodies=tuple(_reframed(body, generator) for body in other.bodies))
    lengths = ("rest_m", "excess_m", "clearance_m", "hinge_radius_m")
    before = judged(thing, WIDE)
    after = judged(other, replace(WIDE, **{name: scale * getattr(WIDE, name) for name in lengths}))
    assert codes(before) == codes(after)
    slack = 2 * SURE * max(1.0, 1.0 / scale)
    assert numbers(after) / scale == pytest.approx(numbers(before), abs=slack, rel=0.03)


def numbers(result):
    """Depths at rest, and excess and clearance of every joint [mm]."""
    rest = [contact["depth_mm"] for contact in result.measurements["rest"]]
    swept = [row[k] for row in result.measurements["joints"] for k in ("excess_mm", "clearance_mm")]
    return np.array([*rest, *(-1.0 if number is None else number for number in swept)])


def _reframed(body, generator):
    """The link's own axes turned anyhow; its joint stays where it is."""
    turn = np.eye(4)
    turn[:3, :3] = Rotation.random(random_state=generator).as_matrix()
    return replace(body, frame=body.frame @ turn)
