"""What a cut may take: depths of both parts together, and shares of what encloses a volume."""

from dataclasses import replace

import numpy as np
import pytest
from held_parts import CONFIG, PAIR, held
from manifold3d import Manifold
from plain_solids import sized_hull

from asset_factory.factory.articulation import Joint
from asset_factory.factory.manufacture.decompose.solids import thickness_m
from asset_factory.factory.manufacture.separate.budget import Loss, overdone, too_bare
from asset_factory.factory.manufacture.separate.clip import SHEET_M, clipped
from asset_factory.factory.manufacture.separate.pair import PartPair, Workpieces

LIMITS = {"free_m": 0.006, "trimmed_m": 0.025}
NOTHING = Loss("flap", *[0.0] * 7)


def judged(lost, solid):
    return overdone((lost, replace(NOTHING, part="bin")), (solid, True), CONFIG, **LIMITS)


@pytest.mark.parametrize(("name", "most"), [("bared_m", 0.006), ("trimmed_m", 0.025)])
def test_depths_are_limited_for_both_parts_together(name, most):
    within = replace(NOTHING, **{name: 0.5 * most})
    both = [within, replace(NOTHING, part="bin", **{name: 0.6 * most})]
    assert judged(within, solid=False) is None
    assert "most of it off 'bin'" in overdone(both, (False, True), CONFIG, **LIMITS)


def test_most_of_the_slabs_over_an_open_surface_may_go_where_nothing_is_bared():
    # A flap of 2 mm is a hull of 5, of which the lid around it needs most.
    lost = replace(NOTHING, share=0.7, open_share=0.7, bared_m=0.003)
    assert judged(lost, solid=False) is None
    assert "70% of 'flap'" in judged(lost, solid=True)
    deeper = replace(lost, bared_m=CONFIG.visible_m + 0.0005)
    assert "70% of 'flap'" in judged(deeper, solid=False)


def test_a_part_may_not_be_bared_over_more_than_its_share():
    assert "bare 6%" in judged(replace(NOTHING, area=0.06), solid=False)


PLATE = sized_hull((0.6, 0.2, 0.002))
FAR = sized_hull((0.1, 0.1, 0.1), (0, 0, 5))
TREE = held([PLATE], [FAR], Joint("slide", "prismatic", 0, 1, [0, 0, 1], [0, 0, 0], 0.0, 0.1))


def lost_by(before, after):
    """What a plate of 600 x 200 x 2 mm loses of what can be seen."""
    bodies = Workpieces(TREE, [[before], [FAR]], CONFIG)
    return PartPair.of(bodies, PAIR).losses(([after], [FAR]))[0]


def test_a_plate_cut_to_a_knife_s_edge_is_bared_though_no_plane_cuts_deep():
    # From the upper edge of one end down to the middle of the lower face.
    normal = np.array([0.002, 0.0, 0.3]) / np.hypot(0.002, 0.3)
    lost = lost_by(PLATE, clipped(PLATE, normal, float(normal @ [0.0, 0.0, -0.001])))
    assert lost.bared_m == pytest.approx(0.004, abs=1e-4)
    assert lost.area == pytest.approx(0.295 / 0.6, abs=0.03)
    assert lost.untouched == pytest.approx(0.29 / 0.6, abs=0.03)
    assert "outside its collision geometry" in too_bare([lost], CONFIG)


def test_cuts_that_take_a_little_each_may_not_bare_much_together():
    left = PLATE
    told = []
    for normal, end in (((1, 0), 0.268), ((-1, 0), 0.268), ((0, 1), 0.086), ((0, -1), 0.086)):
        cut = clipped(left, np.array([*normal, 0.0]), end)
        lost = lost_by(left, cut)
        assert lost.area < CONFIG.planed_area
        told.append(too_bare([lost], CONFIG) is not None)
        left = cut
    assert told == [False, False, False, True]
    # What was bare before is no fault of a cut that bares nothing.
    assert too_bare([lost_by(left, left)], CONFIG) is None


def test_a_thin_board_counts_as_a_sheet_and_a_thick_one_does_not():
    size = np.array([0.2, 0.08, 0.002])
    assert thickness_m(Manifold.cube(size)) == pytest.approx(0.002, rel=0.05)
    assert thickness_m(Manifold.cube(size)) < SHEET_M < thickness_m(Manifold.cube(4.0 * size))
    # A box of such boards is as thin as they are, however much it surrounds.
    box = Manifold.cube([0.2] * 3) - Manifold.cube([0.196] * 3).translate([0.002] * 3)
    assert thickness_m(box) == pytest.approx(0.002, rel=0.1)
    assert thickness_m(None) == 0.0
