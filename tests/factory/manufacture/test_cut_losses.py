"""What a cut may take: depths of both parts together, and shares of what encloses a volume."""

from dataclasses import replace

import pytest

from asset_factory.factory.config import SeparateConfig
from asset_factory.factory.manufacture.separate.budget import CutLimits, Loss, overdone

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
