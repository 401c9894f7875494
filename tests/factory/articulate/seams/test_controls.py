"""Small things in a row on one strip are knobs, and handles where seams part them."""

import numpy as np
import pytest
from tests.samples import one_piece

from asset_factory.factory.articulate.seams.controls import with_strips
from asset_factory.factory.articulate.seams.handles import Face, Protrusion
from asset_factory.factory.articulate.seams.knobs import knobs_of
from asset_factory.factory.articulate.seams.rectangles import Lines
from asset_factory.factory.articulation import JointKind
from asset_factory.factory.part import PartKind


def handle(row, column, rows, columns):
    high = np.array([row + rows - 1, column + columns - 1])
    return Protrusion(np.array([row, column]), high, 6.0, 1.0)


def lines(at, length):
    sums = np.tile(np.arange(length + 1.0), (len(at), 1))
    return Lines(np.array(at, np.int64), sums, sums, sums)


@pytest.mark.parametrize(("parted", "wanted"), [(False, True), (True, False)])
def test_knobs_far_apart_on_one_strip_turn_unless_seams_part_them(parted, wanted):
    knobs = tuple(handle(90, column, 8, 8) for column in (20, 90, 160))
    face = Face(np.zeros((120, 200)), np.zeros((120, 200), np.bool_), knobs)
    level = lines([75, 110], 200)
    upright = lines([60, 130] if parted else [], 120)
    assert all(each.control is wanted for each in with_strips(face, level, upright))


@pytest.mark.parametrize(
    ("name", "axis", "places"),
    [
        ("stove", (0, 1, 0), [(0.28, 0.78), (0.35, 0.78), (0.42, 0.78)]),
        ("microwave", (0, 1, 0), [(0.525, 0.1), (0.525, 0.16), (0.525, 0.22)]),
        ("cooktop", (0, 0, -1), [(0.2, 0.06), (0.3, 0.06), (0.4, 0.06), (0.5, 0.06)]),
    ],
)
def test_knobs_are_cut_out_and_turn_about_their_middles(name, axis, places):
    found = knobs_of(getattr(one_piece, name)(), "auto")
    assert [part.kind for part in found.parts[1:]] == [PartKind.KNOB] * len(places)
    across = [0, 1] if axis[2] else [0, 2]
    at = sorted(tuple(joint.origin[across].tolist()) for joint in found.joints)
    assert np.allclose(at, sorted(places), atol=0.01)
    for joint in found.joints:
        assert joint.kind is JointKind.CONTINUOUS
        assert joint.axis == pytest.approx(axis)


BARS = ("filing_cabinet", "bars_that_meet")


@pytest.mark.parametrize("name", [*BARS, "buttons", "moulding", "table"])
def test_buttons_and_handles_are_no_knobs(name):
    assert not knobs_of(getattr(one_piece, name)(), "auto").joints
