"""The true axis is among the candidates, however the object is turned."""

import numpy as np
import pytest
from evidence_worlds import apart, chest, cupboard, partition
from hypothesis import given, settings
from hypothesis import strategies as st

from asset_factory.factory.articulate.evidence import NOTHING, Guess
from asset_factory.factory.articulate.evidence.body import body_of
from asset_factory.factory.articulate.evidence.candidates import LineSource, find_candidates
from asset_factory.factory.articulation import rotation_about

UP = np.array([0.0, 0.0, 1.0])


@settings(max_examples=10, deadline=None)
@given(st.floats(-3.1, 3.1), st.sampled_from(["left", "right"]))
def test_the_hinge_is_a_candidate_at_any_yaw(yaw, side):
    world = cupboard(side)
    joint = world.joints[0]
    rotation = rotation_about(UP, yaw)
    axis = rotation @ joint.axis
    origin = rotation @ joint.origin
    found = find_candidates(body_of(partition(world, yaw), 1), NOTHING)
    good = ~found.slides & (found.axis @ axis > np.cos(np.radians(1.0)))
    assert min(apart(o, axis, origin) for o in found.origin[good]) < 0.008


def test_the_way_out_of_a_drawer_is_a_candidate():
    found = find_candidates(body_of(partition(chest(), 0.3), 1), NOTHING)
    out = rotation_about(UP, 0.3) @ chest().joints[0].axis
    assert (found.slides & (found.axis @ out > 0.9999)).sum() == 1


def test_each_line_comes_both_ways_round():
    found = find_candidates(body_of(partition(cupboard()), 1), NOTHING)
    assert np.allclose(found.axis[::2], -found.axis[1::2])
    assert np.allclose(found.origin[::2], found.origin[1::2])


def test_a_guess_adds_its_own_line():
    direction = np.array([0.1, 0.2, 1.0])
    point = np.array([0.0, 0.0, 0.3])
    found = find_candidates(body_of(partition(cupboard()), 1), Guess(0.9, direction, point))
    along = found.axis @ direction > 0.9999 * np.linalg.norm(direction)
    mine = (found.source == LineSource.GUESSED) & ~found.slides & along
    assert mine.sum() == 1
    assert np.allclose(found.origin[mine], point)


def test_guesses_that_cannot_be_are_refused():
    with pytest.raises(ValueError, match="want 0 to 1"):
        Guess(turns=1.5)
    with pytest.raises(ValueError, match="points somewhere"):
        Guess(direction=np.zeros(3))
