"""What is no panel, and when doubts about panels count."""

from dataclasses import replace

import numpy as np
import pytest
from tests.samples import one_piece

from asset_factory.factory.articulate.seams import hypotheses
from asset_factory.factory.articulate.seams.candidates import (
    PanelCandidate,
    steps_back,
    usable,
    whole_side,
)
from asset_factory.factory.articulate.seams.controls import with_strips
from asset_factory.factory.articulate.seams.fronts import fronts_of
from asset_factory.factory.articulate.seams.groups import FrontPanel, Group, together
from asset_factory.factory.articulate.seams.handles import Face, Protrusion
from asset_factory.factory.articulate.seams.layouts import rated
from asset_factory.factory.articulate.seams.lids import Lid
from asset_factory.factory.articulate.seams.panels import STRICT
from asset_factory.factory.articulate.seams.rectangles import BOTTOM, TOP, Lines, Rectangle
from asset_factory.factory.articulate.seams.relief import reliefs_of
from asset_factory.factory.views.raster import Side
from asset_factory.factory.views.view import Views


def test_slivers_are_no_doors():
    scene = fronts_of(reliefs_of(Views(one_piece.plain_box())))[Side.FRONT].scene
    bottom, top, left, _ = scene.relief.box
    tall = top - bottom - 20
    door, sliver = (
        Rectangle(
            np.array([bottom + 10, left + 10]),
            np.array([top - 10, left + 10 + round(share * tall)]),
            np.ones(4),
            np.ones(4),
        )
        for share in (0.2, 0.1)
    )
    assert usable(scene, [door, sliver], STRICT) == [door]


def test_a_front_may_show_nothing_but_pieces_between_handles():
    scene = fronts_of(reliefs_of(Views(one_piece.plain_box())))[Side.FRONT].scene
    whole = whole_side(scene)
    middle = (whole.low[0] + whole.high[0]) // 2
    pieces = (whole.with_side(TOP, int(middle)), whole.with_side(BOTTOM, int(middle)))
    (group,) = rated(scene, [PanelCandidate(whole, pieces)])
    assert np.isfinite([panel.value for panel in group.panels]).all()


@pytest.mark.parametrize(
    ("shown", "shut", "wanted"),
    [
        (0.95, np.inf, ["door", "door"]),
        (0.5, np.inf, ["lid"]),
        (0.5, hypotheses.SHUT, ["door", "door"]),
    ],
)
def test_doubtful_panels_yield_to_a_lid_unless_the_network_sees_them_or_they_are_evident(
    monkeypatch, shown, shut, wanted
):
    monkeypatch.setattr(hypotheses, "SHUT", shut)
    seen = hypotheses._Sides.of(reliefs_of(Views(one_piece.doors())))
    assert len(seen.panels) == 2
    lid = Lid(seen.front.relief.box[1] // 2, seen.value - 2.0, 1.0, ((Side.BACK, 0.0),))
    sight = seen.front.sight
    no_end = np.zeros_like(sight.panel)
    seen.front.__dict__["sight"] = replace(
        sight, panel=np.full_like(sight.panel, shown), level=no_end, upright=no_end
    )
    monkeypatch.setattr(hypotheses, "value_of", lambda *_: -1.0)
    movers = hypotheses._openings(replace(seen, lids=[lid]), has_knobs=False)[0]
    assert [mover.kind for mover in movers] == wanted


@pytest.mark.parametrize(("seen", "beside_panels", "wanted"), [
    (0.1, False, False), (0.25, False, True), (0.25, True, False), (0.35, True, True),
])  # fmt: skip
def test_lids_are_seen_by_the_network(seen, beside_panels, wanted):
    assert Lid(3, 5.0, seen, ()).is_seen(beside_panels=beside_panels) is wanted


def _rectangle(*corners):
    bottom, left, top, right = corners
    return Rectangle(np.array([bottom, left]), np.array([top, right]), np.ones(4), np.ones(4))


def _group(value, *corners):
    rectangle = _rectangle(*corners)
    return Group(rectangle, (FrontPanel(rectangle, (), value),))


def test_several_small_panels_beat_a_large_one_that_is_worth_more_than_each():
    rows = [_group(3.0, 10 * row, 0, 10 * row + 10, 40) for row in range(3)]
    assert together([_group(6.0, 0, 0, 30, 40), *rows]) == rows
    whole = _group(10.0, 0, 0, 30, 40)
    assert together([whole, *rows]) == [whole]


def test_what_ends_far_behind_its_middle_is_no_panel():
    scene = fronts_of(reliefs_of(Views(one_piece.plain_box())))[Side.FRONT].scene
    bottom, top, left, right = scene.relief.box
    edge = (bottom + 3 * top) // 4
    height = scene.face.height.copy()
    height[edge:] -= 60.0
    scene = replace(scene, face=replace(scene.face, height=height))
    both = [_rectangle(bottom, left, end, right) for end in (top, edge)]
    assert steps_back(scene, both).tolist() == [True, False]


def _handle(row, column, rows, columns):
    high = np.array([row + rows - 1, column + columns - 1])
    return Protrusion(np.array([row, column]), high, 6.0, 1.0)


@pytest.mark.parametrize(("parted", "wanted"), [(False, True), (True, False)])
def test_knobs_far_apart_on_one_strip_turn_unless_seams_part_them(parted, wanted):
    knobs = tuple(_handle(90, column, 8, 8) for column in (20, 90, 160))
    face = Face(np.zeros((120, 200)), np.zeros((120, 200), np.bool_), knobs)
    level = _lines([75, 110], 200)
    upright = _lines([60, 130] if parted else [], 120)
    assert all(each.control is wanted for each in with_strips(face, level, upright).handles)


def _lines(at, length):
    sums = np.tile(np.arange(length + 1.0), (len(at), 1))
    return Lines(np.array(at, np.int64), sums, sums, sums)


@pytest.mark.parametrize(("closed", "pulled", "wanted"), [
    (0.91, True, True), (0.85, True, False), (1.0, False, False),
])  # fmt: skip
def test_a_groove_all_around_a_handle_needs_no_network(closed, pulled, wanted):
    front = fronts_of(reliefs_of(Views(one_piece.plain_box())))[Side.FRONT]
    front.__dict__["sight"] = replace(front.sight, panel=np.zeros_like(front.sight.panel))
    sides = np.array([closed, 1.0, 1.0, 1.0])
    rectangle = Rectangle(np.array([10, 10]), np.array([100, 80]), sides, sides)
    handles = (_handle(40, 15, 30, 5),) if pulled else ()
    assert hypotheses._is_seen(front, FrontPanel(rectangle, handles, 3.0)) is wanted
