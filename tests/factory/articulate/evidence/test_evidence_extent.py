"""An open drawer goes back as far as it stands out; what is closed, upright or pressed does not."""

import numpy as np
import pytest
from evidence_worlds import chest, cupboard, oven, partition

from asset_factory.factory.articulate.evidence import Guess, best_motion
from asset_factory.factory.articulate.evidence.body import body_of
from asset_factory.factory.articulate.evidence.extent import stands_out_by
from asset_factory.factory.articulate.evidence.rating import load_usual
from asset_factory.factory.articulate.evidence.usual import LONGEST_SLIDE
from asset_factory.factory.geometry.posing import posed

OUT = np.array([0.0, -1.0, 0.0])
THICK = 0.021
"""Of the chest's front, which stands before its carcass."""


def drawn(by):
    """The chest with its drawer pulled out [m]."""
    return partition(posed(chest(), {chest().joints[0].name: by}))


@pytest.mark.parametrize("by", [0.15, 0.25, 0.35])
def test_an_open_drawer_goes_back_as_far_as_it_stands_out(by):
    closed = best_motion(drawn(0.0), 1, Guess(0.0, OUT)).motion
    found = best_motion(drawn(by), 1, Guess(0.0, OUT)).motion
    assert closed.lower == 0.0
    assert found.axis @ OUT > 0.999
    assert -found.lower == pytest.approx(by + THICK, abs=0.01)
    assert found.upper - found.lower == pytest.approx(closed.upper, rel=0.25)


def test_standing_out_is_measured_from_the_holders_mouth():
    for by in (0.0, 0.1, 0.3):
        assert stands_out_by(body_of(drawn(by), 1), OUT) == pytest.approx(by + THICK, abs=0.01)
    assert stands_out_by(body_of(drawn(0.3), 1), -OUT) == 0.0


def test_what_lies_outside_its_holder_or_goes_up_does_not_stand_open():
    assert stands_out_by(body_of(partition(cupboard()), 1), OUT) == 0.0
    assert stands_out_by(body_of(partition(oven()), 2), OUT) == 0.0
    assert stands_out_by(body_of(drawn(0.2), 1), np.array([0.0, 0.0, 1.0])) == 0.0


def test_no_slide_is_many_times_as_long_as_its_part():
    assert load_usual(True).values.max() <= LONGEST_SLIDE
    assert np.isinf(load_usual(False).values).any(), "turns may have no end"
