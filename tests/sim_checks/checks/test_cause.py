"""Every cause is told from an asset broken that way, not from its sound or otherwise broken kin."""

import json
from dataclasses import replace

import numpy as np
import pytest
from box_world import body, box_shape, built, cabinet, penetrating, sliding, turning, with_link
from hypothesis import given
from hypothesis import strategies as st
from small_cabinet import rows

from asset_factory.sim_checks.checks.cause import Cause, shown_cause, way_cause
from asset_factory.sim_checks.config import PenetrationConfig

CONFIG = PenetrationConfig()


def causes(description):
    return [(finding.code, finding.cause) for finding in penetrating(description).findings]


def shown_as(description, name, visible):
    """One link with what another description shows of it."""
    seen = next(link for link in visible.links if link.name == name)
    return with_link(description, name, visuals=seen.visuals)


def bare(description):
    """The same with nothing to see."""
    links = tuple(replace(link, visuals=()) for link in description.links)
    return replace(description, links=links)


def room(way, back=-10.0, upper=0.5):
    """A box that slides along x; a wall stands ``way`` off, perhaps another behind it."""
    walls = [((0.2 + way, 0, 0), (0.2, 1, 1)), ((-0.2 + back, 0, 0), (0.2, 1, 1))]
    box = sliding("box", [((0.0, 0.0, 0.0), (0.2, 0.2, 0.2))], (1, 0, 0), upper)
    return built(box, base=body("base", walls))


def thin_wall():
    """The wall's hull is met 0.1 m before what is seen of it."""
    seen = box_shape((0.55, 0.0, 0.0), (0.01, 1.0, 1.0))
    return with_link(room(0.3, upper=0.4), "base", visuals=(seen,))


def hung(x, up):
    """A wall at its right and one before it: it can only hang at its left and open backwards."""
    walls = body("base", [((0.32, 0, 0), (0.02, 0.3, 0.4)), ((0, -0.2, 0), (0.7, 0.02, 0.4))])
    leaf = [((0.0, 0.0, 0.0), (0.6, 0.02, 0.3))]
    return built(turning("leaf", leaf, (x, -0.01, 0.0), (0, 0, up), 1.5), base=walls)


EXCLUDED = frozenset({frozenset({"carcass", "door"})})


@pytest.mark.parametrize(
    ("thing", "found"),
    [
        (shown_as(cabinet("wide"), "drawer", cabinet()), {("rest_penetration", "hull_inflation")}),
        (cabinet("wide"), {("rest_penetration", "parts_overlap")}),
        (bare(cabinet("wide")), {("rest_penetration", None)}),
        (cabinet("axis_flip"), {("sweep_penetration", "wrong_axis")}),
        (bare(cabinet("axis_flip")), {("sweep_penetration", None)}),
        (cabinet("hinge_inside"), {("sweep_penetration", "wrong_axis")}),
        # A pair that may touch says nothing of the axis.
        (replace(cabinet("hinge_inside"), excluded=EXCLUDED), {("excluded_penetration", None)}),
        (hung(0.3, -1.0), {("sweep_penetration", "wrong_axis")}),
        (hung(-0.3, 1.0), set()),
        (room(0.1), {("sweep_penetration", "wrong_axis")}),
        (room(0.4), {("sweep_penetration", "limit_too_long")}),
        (bare(room(0.4)), {("sweep_penetration", "limit_too_long")}),
        (room(0.51), set()),
        (room(0.1, back=0.0), {("sweep_penetration", None)}),
        (thin_wall(), {("sweep_penetration", "hull_inflation")}),
    ],
    ids=[
        "fat hulls around a drawer that fits", "a drawer too wide", "hulls of a drawer too wide",
        "a door that opens inwards", "hulls of a door that opens inwards",
        "a hinge inside the edge", "a hinge inside the edge of a pair that may touch",
        "a hinge at the wrong edge", "a hinge at the right edge", "a slide the wrong way",
        "a wall at its end", "hulls of a wall at its end", "a wall behind its end",
        "walls all round", "fat hulls along the way",
    ],
)  # fmt: skip
def test_each_way_to_be_broken_has_its_cause(thing, found):
    assert set(causes(thing)) == found


HINGE = (-0.3, -0.202, 0.6)


def test_a_chip_of_the_carcass_that_is_called_the_doors_has_leaked():
    chip = box_shape(np.subtract((0.291, -0.19, 0.6), HINGE), (0.03, 0.012, 0.03))
    shapes = (*cabinet().links[2].collisions, chip)
    found = causes(with_link(cabinet(), "door", collisions=shapes, visuals=shapes))
    assert ("rest_penetration", "leaked_segment") in found


def test_finding_and_measurements_say_the_same_and_the_message_says_why():
    result = penetrating(cabinet("wide"))
    (finding,) = result.findings
    (measured,) = [item for item in result.measurements["rest"] if item["depth_mm"] > 2.0]
    assert (measured["cause"], finding.cause) == ("parts_overlap", "parts_overlap")
    assert type(finding.cause) is str
    assert measured["visual_mm"] == pytest.approx(-5.0, rel=0.05)
    assert finding.message.endswith("the visible parts themselves overlap")
    assert json.loads(json.dumps(result.measurements)) == result.measurements


def test_a_joints_visible_clearance_stands_beside_its_hulls():
    """The drawer's hulls leave 2 mm, what is seen of it 3 mm."""
    slim = cabinet()
    visuals = tuple(
        replace(shape, vertices=shape.vertices * [(0.279 / 0.28), 1.0, 1.0])
        for shape in slim.links[1].visuals[:2]
    )
    slide = rows(penetrating(with_link(slim, "drawer", visuals=visuals)))["slide"]
    assert slide["clearance_mm"] == pytest.approx(2.0, abs=0.05)
    assert slide["visual_clearance_mm"] == pytest.approx(3.0, abs=0.05)


def test_a_sound_cabinet_needs_no_explanation():
    measured = penetrating(cabinet()).measurements
    contacts = [*measured["rest"], *(pair for item in measured["joints"] for pair in item["pairs"])]
    assert contacts
    assert {item["cause"] for item in contacts} == {None}


WAY = {"clear": 0.2, "excess": 0.03, "otherwise": 0.03, "at_rest": 0.0}


def cause(way=WAY, depth=0.03, allowed=0.001, visual=-0.03, leaked=False, at_rest=False):
    """What the surfaces say; where they say nothing, what the way does."""
    told = shown_cause(depth, allowed, visual, leaked=leaked, at_rest=at_rest)
    if told or way is None:
        return told
    return way_cause(**way, seen=visual is not None, config=CONFIG)


@pytest.mark.parametrize(
    ("numbers", "expected"),
    [
        ({}, None),
        ({"visual": 0.001}, Cause.HULL_INFLATION),
        ({"visual": -0.0009}, Cause.HULL_INFLATION),
        ({"visual": -0.002}, None),
        ({"leaked": True}, Cause.LEAKED_SEGMENT),
        ({"way": None, "at_rest": True}, Cause.PARTS_OVERLAP),
        ({"way": None, "at_rest": True, "visual": None}, None),
        ({"way": None}, None),
        ({"way": WAY | {"clear": 0.6}}, Cause.LIMIT_TOO_LONG),
        ({"way": WAY | {"clear": 0.6, "otherwise": 0.0}}, Cause.LIMIT_TOO_LONG),
        ({"way": WAY | {"otherwise": 0.0005}}, Cause.WRONG_AXIS),
        ({"way": WAY | {"otherwise": 0.007}}, Cause.WRONG_AXIS),
        ({"way": WAY | {"otherwise": 0.009}}, None),
        ({"way": WAY | {"clear": 0.01}}, Cause.WRONG_AXIS),
        ({"way": WAY | {"clear": 0.01, "at_rest": 0.01}}, Cause.PARTS_OVERLAP),
        ({"visual": None, "way": WAY | {"otherwise": 0.0}}, None),
    ],
)
def test_what_the_numbers_say(numbers, expected):
    assert cause(**numbers) is expected


@given(depth=st.floats(0.0021, 1.0), share=st.floats(-1.0, 1.0), leaked=st.booleans())
def test_at_rest_what_is_seen_always_decides(depth, share, leaked):
    """The deeper the visible surfaces lie, the less the hulls are to blame."""
    met = (None, depth, CONFIG.rest_m)
    assert cause(*met, share * depth, leaked, at_rest=True) is not None
    told = cause(*met, min(0.0, share * depth) - CONFIG.rest_m - 1e-6, leaked, at_rest=True)
    assert told is (Cause.LEAKED_SEGMENT if leaked else Cause.PARTS_OVERLAP)
