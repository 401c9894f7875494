"""Panels that the picture network alone is sure of, and how it counts among three judges."""

from dataclasses import replace

import numpy as np
import pytest
from tests.samples import one_piece

from asset_factory.factory.articulate.seams import fronts as fronts_module
from asset_factory.factory.articulate.seams.fronts import fronts_of
from asset_factory.factory.articulate.seams.glimpses import glimpsed
from asset_factory.factory.articulate.seams.groups import FrontPanel
from asset_factory.factory.articulate.seams.hypotheses import hypotheses_of_reliefs
from asset_factory.factory.articulate.seams.motions import openings_of
from asset_factory.factory.articulate.seams.rectangles import Rectangle
from asset_factory.factory.articulate.seams.relief import reliefs_of
from asset_factory.factory.articulate.seams.sight import SQUARE, Sight
from asset_factory.factory.part import OpensBy
from asset_factory.factory.views.raster import Side
from asset_factory.factory.views.view import Views

#: First row and column of the two doors, and those after the last, in squares.
DOORS = (((10, 12), (90, 42)), ((10, 43), (90, 73)))


def seen_as(relief, panel=0.95, end=0.95):
    """Two doors beside each other on every side, hinged on their left."""
    shape = tuple(-(-length // SQUARE) for length in relief.shape)
    nothing = np.zeros(shape)
    doors, level, upright = nothing.copy(), nothing.copy(), nothing.copy()
    for (bottom, left), (top, right) in DOORS:
        doors[bottom:top, left:right] = panel
        level[[bottom - 1, top], left:right] = end
        upright[bottom:top, [left - 1, right]] = end
    ways = np.zeros((len(OpensBy), *shape))
    ways[0] = 1.0
    return Sight(doors, nothing, level, upright, ways)


@pytest.fixture
def box():
    """Of a box on which nothing is seen but what a test says."""
    return fronts_of(reliefs_of(Views(one_piece.plain_box())))[Side.FRONT]


def with_sight(front, **seen):
    told = replace(front)
    told.__dict__["sight"] = seen_as(front.relief, **seen)
    return told


def test_two_doors_end_where_an_end_is_seen(box):
    panels = glimpsed(with_sight(box))
    corners = sorted((*each.rectangle.low, *each.rectangle.high) for each in panels)
    expected = [[SQUARE * at for at in (*low, *high)] for low, high in DOORS]
    assert np.abs(np.array(corners) - expected).max() <= SQUARE
    assert all(each.value > 1.0 for each in panels)


@pytest.mark.parametrize("doubt", [{"panel": 0.7}, {"end": 0.5}])
def test_what_is_doubtful_is_no_panel(box, doubt):
    assert not glimpsed(with_sight(box, **doubt))


def test_without_an_end_in_between_they_are_one(box):
    front = with_sight(box)
    front.sight.panel[10:90, 42] = 0.95
    front.sight.upright[10:90, 40:45] = 0.0
    (found,) = glimpsed(front)
    assert found.rectangle.low.tolist() == [20, 24]
    assert found.rectangle.high.tolist() == [180, 146]


def test_a_frame_that_looks_like_a_panel_is_left_out(box):
    front = with_sight(box)
    front.sight.panel[7:93, 9:76] = 0.95
    panels = glimpsed(front)
    corners = sorted((*each.rectangle.low, *each.rectangle.high) for each in panels)
    expected = [[SQUARE * at for at in (*low, *high)] for low, high in DOORS]
    assert np.abs(np.array(corners) - expected).max() <= SQUARE


def test_nothing_opens_where_nothing_is_there(box):
    seen = box.relief.seen.copy()
    (bottom, left), (top, right) = DOORS[0]
    seen[SQUARE * bottom : SQUARE * top, SQUARE * left : SQUARE * right] = False
    holed = replace(box, relief=replace(box.relief, seen=seen))
    (door,) = glimpsed(with_sight(holed))
    assert door.rectangle.low[1] == pytest.approx(SQUARE * DOORS[1][0][1], abs=SQUARE)


def test_where_nothing_else_is_found_it_is_read(monkeypatch):
    reliefs = reliefs_of(Views(one_piece.plain_box()))
    assert hypotheses_of_reliefs(reliefs) == ()
    monkeypatch.setattr(fronts_module, "sight_of", seen_as)
    movers = hypotheses_of_reliefs(reliefs)[0]
    assert len(movers) == 2
    assert all(mover.existence > 0.8 for mover in movers)


def test_it_counts_for_one_of_three_in_how_a_panel_opens(box):
    rectangle = Rectangle(np.array([20, 24]), np.array([180, 84]), np.ones(4), np.ones(4))
    panel = FrontPanel(rectangle, (), 1.0)
    chances = {}
    for number, way in ((0, OpensBy.LEFT), (4, OpensBy.OUT)):
        sight = seen_as(box.relief)
        sight.ways[:] = 0.0
        sight.ways[number] = 1.0
        opening = openings_of(box.scene, [panel], sight)[0]
        assert sum(chance for _, chance in opening.ways) == pytest.approx(1.0)
        chances[way] = dict(opening.ways)
    assert chances[OpensBy.LEFT][OpensBy.LEFT] > 2.0 * chances[OpensBy.OUT][OpensBy.LEFT]
    assert chances[OpensBy.OUT][OpensBy.OUT] > 2.0 * chances[OpensBy.LEFT][OpensBy.OUT]
