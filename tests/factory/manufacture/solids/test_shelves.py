"""Shelves behind doors: even, clear of what moves, in the colour of the inside."""

import numpy as np
import pytest
from labelled_skins import SIZE, bin_with_lid, chest, cupboard

from asset_factory.factory.config import SolidsConfig
from asset_factory.factory.intake.categories import Category
from asset_factory.factory.manufacture.decompose.convex import depth_below
from asset_factory.factory.manufacture.separate.clip import meeting
from asset_factory.factory.manufacture.solids.boards import SHELF_M, shelf_boards
from asset_factory.factory.manufacture.solids.box import Box
from asset_factory.factory.manufacture.solids.build import solids

CONFIG = SolidsConfig()
SHELVED = Category("cupboard", "height", 0.9, (0.3, 2.0), shelves=0.3, liner="#ff0000")
HOLLOW = Box(np.array([-0.3, 0.1, 0.0]), np.array([0.3, 1.0, 0.5]))


@pytest.mark.parametrize(("spacing", "count"), [(0.3, 2), (0.4, 1), (0.7, 0), (2.0, 0)])
def test_shelves_divide_a_hollow_evenly(spacing, count):
    boards = shelf_boards([HOLLOW], spacing)
    assert len(boards) == count
    edges = [0.1, *((board.low[1] + board.high[1]) / 2.0 for board in boards), 1.0]
    np.testing.assert_allclose(np.diff(edges), 0.9 / (count + 1))
    for board in boards:
        assert board.size[1] == pytest.approx(SHELF_M)
        assert board.low[2] > HOLLOW.low[2]
        np.testing.assert_array_equal(board.size[[0]], HOLLOW.size[[0]])


def test_a_hollow_too_shallow_for_a_shelf_has_none():
    flat = Box(HOLLOW.low, np.array([0.3, 1.0, 0.05]))
    assert shelf_boards([flat], 0.3) == ()


def test_a_cupboard_has_shelves_that_its_door_clears():
    made = solids(cupboard(), CONFIG, usual=SHELVED)
    plain = solids(cupboard(), CONFIG)
    body, door = made.pieces
    (shelf,) = [each for each in made.surfaces if each.kind == "shelf"]
    assert (shelf.part, shelf.rule) == ("body", "usual")
    # As high as the middle of the hollow, where the plain one is empty.
    middle = np.array([[0.0, 0.1, SIZE[2] / 2.0]])
    filled = [any((depth_below(hull, middle) > 0.0).all() for hull in each.pieces[0].hulls)
              for each in (plain, made)]  # fmt: skip
    assert filled == [False, True]
    (joint,) = made.articulation.joints
    for value in np.linspace(0.0, joint.upper, 9):
        pose = joint.motion(float(value))
        assert all(meeting(a, b, pose).depth < -0.002 for a in body.hulls for b in door.hulls)


def test_the_inside_has_its_own_colour():
    mesh = solids(cupboard(), CONFIG, usual=SHELVED).articulation.mesh
    colors = {material.name: material.color for material in mesh.materials}
    assert colors["liner_body"] == colors["liner_panel_1"] == (1.0, 0.0, 0.0, 1.0)
    assert colors["inner_body"] != colors["liner_body"]


@pytest.mark.parametrize("given", [chest, bin_with_lid])
def test_neither_drawers_nor_lids_have_shelves(given):
    made = solids(given(), CONFIG, usual=SHELVED)
    assert "shelf" not in {each.kind for each in made.surfaces}
