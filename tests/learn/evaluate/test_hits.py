"""What is missed counts as wrong: figures over all true moving parts, in closed form."""

from dataclasses import replace

import numpy as np
import pytest
from cupboards import cupboard, hinge, in_one_piece, rail, stuck, turning_drawer

from asset_factory.learn.evaluate.physical import physical

DOOR = cupboard(hinge())
DRAWER = cupboard(rail())
NAMES = ("type_of_all", "axis_of_all", "place_of_all", "place_of_all_strict", "joint_right")


def of_all(truth, predicted):
    """The five figures, in the order of ``NAMES``."""
    pooled = physical(truth, predicted).pooled
    return tuple(pooled[name] for name in NAMES)


def tilted(degrees):
    """About the middle of the front, so that only the angle is wrong there."""
    angle = np.radians(degrees)
    axis = np.array([np.sin(angle), 0.0, np.cos(angle)])
    return cupboard(replace(hinge(), axis=axis, origin=np.array([0.0, 0.0, 0.5])))


def test_the_truth_is_right_in_everything():
    assert of_all(DOOR, DOOR) == ((1.0,),) * 5
    assert of_all(DRAWER, DRAWER) == ((1.0,), (1.0,), (), (), (1.0,))


@pytest.mark.parametrize(
    "predicted", [in_one_piece(DOOR), cupboard(stuck())], ids=["missed", "left where it is"]
)
def test_what_is_missed_is_wrong_in_everything(predicted):
    assert of_all(DOOR, predicted) == ((0.0,),) * 5


@pytest.mark.parametrize(
    ("x", "place", "strict"), [(0.01, 1.0, 1.0), (0.03, 1.0, 0.0), (0.06, 0.0, 0.0)]
)
def test_a_hinge_beside_its_place(x, place, strict):
    """The longest side is 1 m."""
    assert of_all(DOOR, cupboard(hinge(x))) == ((1.0,), (1.0,), (place,), (strict,), (place,))


@pytest.mark.parametrize(("degrees", "right"), [(4.9, 1.0), (-4.9, 1.0), (5.1, 0.0)])
def test_a_tilted_axis_in_its_place(degrees, right):
    assert of_all(DOOR, tilted(degrees)) == ((1.0,), (right,), (1.0,), (1.0,), (right,))


def test_another_type_has_neither_axis_nor_place():
    assert of_all(DOOR, DRAWER) == ((0.0,),) * 5
    assert of_all(DRAWER, DOOR) == ((0.0,), (0.0,), (), (), (0.0,))


def test_half_of_what_turns_and_slides_has_an_axis_and_a_place_but_not_the_type():
    both = turning_drawer()
    assert of_all(both, both) == ((1.0,),) * 5
    assert of_all(both, cupboard(hinge(0.03))) == ((0.0,), (1.0,), (1.0,), (0.0,), (0.0,))
