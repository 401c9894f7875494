"""What a cut may take: depths of both parts together, and shares of what encloses a volume."""

from dataclasses import replace

import numpy as np
import pytest
from manifold3d import Manifold

from asset_factory.factory.config import SeparateConfig
from asset_factory.factory.manufacture.separate.budget import CutLimits, Loss, overdone
from asset_factory.factory.manufacture.separate.clip import SHEET_M
from asset_factory.factory.manufacture.separate.overlap import thickness_m

CONFIG = SeparateConfig()
LIMITS = CutLimits(free_m=0.006, planed_m=0.025, share=0.5)
NOTHING = Loss(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def judged(lost, solid):
    return overdone(("flap", "bin"), (lost, NOTHING), (solid, True), LIMITS, CONFIG)


def test_a_cut_that_takes_nothing_is_fine():
    assert judged(NOTHING, solid=True) is None


@pytest.mark.parametrize(("name", "most"), [("bared_m", 0.006), ("planed_m", 0.025)])
def test_depths_are_limited_for_both_parts_together(name, most):
    within = replace(NOTHING, **{name: 0.5 * most})
    both = [within, replace(NOTHING, **{name: 0.6 * most})]
    assert judged(within, solid=False) is None
    told = overdone(("flap", "bin"), both, (False, True), LIMITS, CONFIG)
    assert "most of it off 'bin'" in told


def test_most_of_the_slabs_over_an_open_surface_may_go_where_nothing_is_bared():
    # A flap of 2 mm is a hull of 5, of which the lid around it needs most.
    lost = replace(NOTHING, share=0.7, open_share=0.7, bared_m=0.003)
    assert judged(lost, solid=False) is None
    assert "70% of 'flap'" in judged(lost, solid=True)
    deeper = replace(lost, bared_m=CONFIG.visible_m + 0.0005)
    assert "70% of 'flap'" in judged(deeper, solid=False)


def test_a_part_may_not_be_bared_over_more_than_its_share():
    assert "bare 6%" in judged(replace(NOTHING, area=0.06), solid=False)


def test_a_thin_board_counts_as_a_sheet_and_a_thick_one_does_not():
    size = np.array([0.2, 0.08, 0.002])
    assert thickness_m(Manifold.cube(size)) == pytest.approx(0.002, rel=0.05)
    assert thickness_m(Manifold.cube(size)) < SHEET_M < thickness_m(Manifold.cube(4.0 * size))
    # A box of such boards is as thin as they are, however much it surrounds.
    box = Manifold.cube([0.2, 0.2, 0.2]) - Manifold.cube([0.196, 0.196, 0.196]).translate(
        [0.002] * 3
    )
    assert thickness_m(box) == pytest.approx(0.002, rel=0.1)
    assert thickness_m(None) == 0.0
