"""Readings of one mesh from different samples: what they share, and which one stands for all."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from asset_factory.factory.models.particulate.agreement import consensus, part_agreement
from asset_factory.factory.models.particulate.decoding import Decoded, DecodedPart
from asset_factory.factory.models.particulate.frames import UnitBox
from asset_factory.factory.models.particulate.motion import Line, PredictedMotion
from asset_factory.factory.models.particulate.prediction import MotionClass

UNIT = UnitBox(np.zeros(3), 1.0)
AREAS = np.ones(10)
X = np.eye(3)[0]
Z = np.eye(3)[2]


def hinge(direction=Z):
    return PredictedMotion(MotionClass.REVOLUTE, 1.0, Line(direction, np.zeros(3), 0.0), (0.0, 1.0))


def drawer(direction=X):
    return PredictedMotion(MotionClass.PRISMATIC, 1.0, slide_direction=direction, slide=(0.0, 0.2))


def reading(labels, *motions):
    """Part 0 is the root and holds the others."""
    root = DecodedPart(0, 1.0, None, hinge())
    movers = [DecodedPart(number, 1.0, 1.0, motion) for number, motion in enumerate(motions, 1)]
    edges = tuple((0, part.query) for part in movers)
    return Decoded(np.asarray(labels), (root, *movers), edges, UNIT)


HALVES = [0] * 5 + [1] * 5


def test_a_reading_agrees_with_itself_whatever_the_numbers_of_its_parts():
    one = reading([0, 0, 1, 1, 2, 2, 0, 0, 0, 0], hinge(), drawer())
    other = reading([0, 0, 2, 2, 1, 1, 0, 0, 0, 0], drawer(), hinge())
    assert part_agreement(one, other, AREAS) == pytest.approx([1.0, 1.0, 1.0])


@pytest.mark.parametrize(
    ("motion", "share"),
    [(hinge(-Z), 1.0), (drawer(), 0.0), (hinge(X), 0.0), (hinge(np.array([0, 0.6, 0.8])), 0.8)],
)
def test_parts_that_move_otherwise_agree_less(motion, share):
    one = reading(HALVES, hinge())
    assert part_agreement(one, reading(HALVES, motion), AREAS) == pytest.approx([1.0, share])


def test_overlap_is_by_area_and_unmatched_parts_have_none():
    one = reading(HALVES, hinge())
    other = reading([0] * 6 + [1] * 4, hinge())
    assert part_agreement(one, other, AREAS) == pytest.approx([5 / 6, 4 / 5])
    heavy = np.where(np.arange(10) == 5, 5.0, 1.0)
    assert part_agreement(one, other, heavy) == pytest.approx([5 / 10, 4 / 9])
    split = reading([0] * 5 + [1, 1, 1, 2, 2], hinge(), hinge())
    assert part_agreement(split, one, AREAS) == pytest.approx([1.0, 3 / 5, 0.0])


def test_the_odd_one_out_is_not_chosen():
    usual = reading(HALVES, hinge())
    odd = reading([0, 1] * 5, hinge())
    found = consensus((odd, usual, usual), AREAS)
    assert found.chosen is usual
    assert found.samples == 3
    # It has the other usual one's full support and next to none of the odd one's.
    assert found.part_agreement == pytest.approx([(1 + 3 / 7) / 2, (1 + 3 / 7) / 2])
    # One alone is taken as it is.
    assert consensus((odd,), AREAS).part_agreement is None


@given(st.integers(0, 10**6))
def test_agreement_is_a_share_and_the_first_of_equals_is_taken(seed):
    rng = np.random.default_rng(seed)

    def any_reading():
        labels = np.concatenate([[0, 1, 2], rng.integers(0, 3, 7)])
        return reading(labels, *rng.permutation([hinge(), drawer()]))

    readings = tuple(any_reading() for _ in range(3))
    found = consensus(readings, rng.random(10))
    assert all(0.0 <= share <= 1.0 for share in found.part_agreement)
    assert consensus((readings[0],) * 3, AREAS).chosen is readings[0]
