"""What cuts left needlessly apart is joined again, and nothing is filled by it."""

import numpy as np
import pytest
from plain_solids import sized_hull

from asset_factory.factory.manufacture.decompose.convex import depth_below
from asset_factory.factory.manufacture.decompose.pieces import SolidPieces
from asset_factory.factory.manufacture.separate.separate import with_hulls

PANEL = SolidPieces((sized_hull((0.3, 0.3, 0.02)),), "exact")
#: The panel in nine tiles, without the one in the middle.
PLACES = [(x, y, 0.0) for x in (-0.1, 0.0, 0.1) for y in (-0.1, 0.0, 0.1) if (x, y) != (0.0, 0.0)]
TILES = [sized_hull((0.1, 0.1, 0.02), place) for place in PLACES]


def test_tiles_around_a_hole_become_four_walls_and_the_hole_stays_open():
    after = with_hulls(PANEL, TILES, 64)
    assert len(after.hulls) == 4
    assert sum(hull.volume for hull in after.hulls) == pytest.approx(8 * 0.1 * 0.1 * 0.02)
    hole = np.random.default_rng(0).uniform(-0.0499, 0.0499, (500, 3)) * [1.0, 1.0, 0.2]
    assert max(depth_below(hull, hole).max() for hull in after.hulls) < 0.0


def test_tiles_further_apart_than_rounding_stay_apart():
    apart = [sized_hull((0.1, 0.1, 0.02)), sized_hull((0.1, 0.1, 0.02), (0.101, 0.0, 0.0))]
    assert len(with_hulls(PANEL, apart, 64).hulls) == 2


def test_a_part_that_was_not_cut_is_the_same():
    assert with_hulls(PANEL, list(PANEL.hulls), 64) is PANEL
