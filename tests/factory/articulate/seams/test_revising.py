"""What the picture network changes about panels that others found."""

from dataclasses import replace

import numpy as np
import pytest
from tests.samples import one_piece

from asset_factory.factory.articulate.seams.fronts import fronts_of
from asset_factory.factory.articulate.seams.groups import FrontPanel
from asset_factory.factory.articulate.seams.planks import beyond_planks
from asset_factory.factory.articulate.seams.rectangles import Rectangle
from asset_factory.factory.articulate.seams.relief import reliefs_of
from asset_factory.factory.articulate.seams.revising import revised
from asset_factory.factory.articulate.seams.sight import SQUARE, Sight
from asset_factory.factory.part import OpensBy
from asset_factory.factory.views.raster import Side
from asset_factory.factory.views.view import Views


def rectangle(low, high):
    return Rectangle(np.array(low), np.array(high), np.ones(4), np.ones(4))


def with_sight(front, seen):
    """The same, and the network is sure of these alone."""
    shape = tuple(-(-length // SQUARE) for length in front.relief.shape)
    panel, level, upright = np.zeros(shape), np.zeros(shape), np.zeros(shape)
    for each in seen:
        bottom, left = each.low // SQUARE
        top, right = each.high // SQUARE
        panel[bottom:top, left:right] = 0.95
        level[[bottom - 1, top], left:right] = 0.95
        upright[bottom:top, [left - 1, right]] = 0.95
    told = replace(front)
    told.__dict__["sight"] = Sight(
        panel, np.zeros(shape), level, upright, np.full((len(OpensBy), *shape), 1.0 / len(OpensBy))
    )
    return told


@pytest.fixture(scope="module")
def doors():
    """Of a pair of doors with an upright bar on each."""
    return fronts_of(reliefs_of(Views(one_piece.doors())))[Side.FRONT]


@pytest.fixture
def pair(doors):
    """The doors, as they are."""
    bottom, top, left, right = doors.relief.box
    middle = (left + right) // 2
    rectangles = (
        rectangle((bottom + 10, left + 10), (top - 10, middle - 2)),
        rectangle((bottom + 10, middle + 2), (top - 10, right - 10)),
    )
    found = [FrontPanel(each, doors.scene.handles_in(each), 0.5) for each in rectangles]
    assert all(len(panel.handles) == 1 for panel in found)
    return found


def moved(panel, low=0, high=0):
    """With its left and right side elsewhere [pixels]."""
    old = panel.rectangle
    return replace(
        panel,
        rectangle=rectangle((old.low[0], old.low[1] + low), (old.high[0], old.high[1] + high)),
    )


def columns(panels):
    return sorted([int(each.rectangle.low[1]), int(each.rectangle.high[1])] for each in panels)


def test_cuts_that_nobody_saw_move_to_the_ends_seen(doors, pair):
    front = with_sight(doors, [panel.rectangle for panel in pair])
    cut = [replace(moved(pair[0], high=-12), cut=True), replace(moved(pair[1], low=-12), cut=True)]
    assert np.abs(np.subtract(columns(revised(front, cut, [])), columns(pair))).max() <= 4


def test_a_cut_stays_where_the_network_sees_one_of_two(doors, pair):
    front = with_sight(doors, [pair[0].rectangle])
    cut = [replace(panel, cut=True) for panel in pair]
    assert revised(front, cut, []) == cut


def test_a_doubted_panel_becomes_what_is_seen_around_its_handle(doors, pair):
    front = with_sight(doors, [pair[0].rectangle])
    wide = moved(pair[0], high=pair[1].rectangle.high[1] - pair[0].rectangle.high[1])
    (found,) = revised(front, [wide], [])
    assert found.handles == wide.handles
    assert np.abs(np.subtract(columns([found]), columns([pair[0]]))).max() <= 4


def test_a_doubted_panel_stays_if_nothing_better_is_seen(doors, pair):
    assert revised(with_sight(doors, []), pair, []) == pair


def test_what_the_network_is_sure_of_stays(doors, pair):
    front = with_sight(doors, [panel.rectangle for panel in pair])
    assert revised(front, pair, []) == pair


def test_a_panel_seen_beside_others_is_added(doors, pair):
    front = with_sight(doors, [panel.rectangle for panel in pair])
    found = revised(front, pair[:1], [])
    assert found[0] is pair[0]
    assert np.abs(np.subtract(columns(found), columns(pair))).max() <= 4


def test_what_is_seen_beside_a_panel_ends_at_its_border(doors, pair):
    wide = moved(pair[0], high=int(pair[1].rectangle.size[1]) // 8)
    found = revised(with_sight(doors, [panel.rectangle for panel in pair]), [wide], [])
    assert len(found) == 2
    assert found[1].rectangle.low[1] == wide.rectangle.high[1]


@pytest.mark.parametrize(("seen", "count"), [(0.9, 2), (0.2, 1)])
def test_a_knob_on_an_end_that_is_seen_opens_two_doors(doors, pair, seen, count):
    low = pair[0].rectangle.low
    high = pair[1].rectangle.high
    middle = (low + high) // 2
    half = np.array([4, 8])
    knob = replace(pair[0].handles[0], low=middle - half, high=middle + half)
    whole = replace(pair[0], rectangle=rectangle(tuple(low), tuple(high)), handles=(knob,))
    front = with_sight(doors, [whole.rectangle])
    front.sight.upright[:, middle[1] // SQUARE] = seen
    found = revised(front, [whole], [])
    assert len(found) == count
    if count == 2:
        seam = int(found[0].rectangle.high[1])
        assert abs(seam - middle[1]) <= SQUARE
        assert found[1].rectangle.low[1] == seam
        assert found[0].handles[0].high[1] < seam < found[1].handles[0].low[1]


def test_a_door_found_between_two_planks_goes_on_to_where_it_ends(doors, pair):
    bottom, top, _, _ = doors.relief.box
    left, right = (panel.rectangle for panel in pair)
    (bar,) = pair[0].handles
    lines = doors.scene.level.at
    foot, head = (int(lines[np.abs(lines - at).argmin()]) for at in (bottom + 10, top - 10))
    door, other = (rectangle((foot, each.low[1]), (head, each.high[1])) for each in (left, right))
    cell = rectangle((int(bar.low[0]) - 6, left.low[1]), (int(bar.high[0]) + 6, left.high[1]))
    bare = rectangle((foot, left.low[1]), (int(bar.low[0]) - 6, left.high[1]))
    cells = [replace(pair[0], rectangle=cell), FrontPanel(bare, (), 0.5)]
    (found,) = beyond_planks(with_sight(doors, [door, other]), cells)
    assert found.rectangle.low.tolist() == door.low.tolist()
    assert found.rectangle.high.tolist() == door.high.tolist()

    ends_there = with_sight(doors, [cell, bare])
    assert beyond_planks(ends_there, cells) == cells
