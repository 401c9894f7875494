"""What the articulator of one-piece meshes learns from: pictures of objects, and their truth."""

import numpy as np

from asset_factory.factory.articulate.seams.features import MOTION_NAMES, NAMES
from asset_factory.factory.part import OpensBy
from asset_factory.factory.views.raster import Side
from asset_factory.learn.elevations.pictures import pictures_of
from asset_factory.learn.elevations.rows import rows_of
from asset_factory.learn.elevations.truths import truth_of
from asset_factory.learn.objects import make_object

SIDES = (Side.FRONT, Side.BACK, Side.TOP)


def test_doors_of_a_fridge_are_truths_of_its_front():
    fridge = make_object("fridge", 1)
    pictures = pictures_of(fridge, np.random.default_rng(0), SIDES)
    panels = truth_of(fridge, pictures)
    assert len(panels) == len(fridge.joints)
    assert {panel.side for panel in panels} == {Side.FRONT}
    assert {panel.way for panel in panels} <= {OpensBy.LEFT, OpensBy.RIGHT}


def test_a_lid_is_no_panel():
    chest = make_object("chest", 1)
    pictures = pictures_of(chest, np.random.default_rng(0), SIDES)
    assert truth_of(chest, pictures) == ()


def test_the_same_seed_shows_the_same_object():
    drawers = make_object("filing_cabinet", 2)
    one = rows_of(drawers, np.random.default_rng(4))
    other = rows_of(drawers, np.random.default_rng(4))
    assert np.array_equal(one.panel, other.panel)
    assert np.array_equal(one.motion, other.motion)
    assert one.panel.shape[1] == len(NAMES)
    assert one.motion.shape == (one.wanted, len(MOTION_NAMES))
    assert one.panel_true.max() > 0.7
