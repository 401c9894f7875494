from dataclasses import replace

import numpy as np
import pytest
from cupboards import cupboard, hinge, in_one_piece, rail, stuck, turning_drawer
from hypothesis import given, settings
from hypothesis import strategies as st

from asset_factory.factory.articulation import Articulation, JointKind, Part
from asset_factory.factory.geometry.posing import posed, turned
from asset_factory.learn.evaluate.physical import STATES, physical
from asset_factory.learn.evaluate.transfer import merged

DOOR = cupboard(hinge())
DRAWER = cupboard(rail())
#: Figures over all true moving parts, in which what is missed counts as wrong.
NAMES = ("type_of_all", "axis_of_all", "place_of_all", "place_of_all_strict", "joint_right")


def reach(angle, tolerance=0.05):
    """How far from its hinge a door that is wrong by an angle is still within the tolerance [m]."""
    return min(1.0, tolerance / (2.0 * np.sin(angle / 2.0)))


def iou_of(reaches):
    """Mean IoU over states where only so much of 1 m2 gets where it should."""
    return np.mean([r / (2.0 - r) for r in reaches])


def test_a_hinge_that_turns_the_wrong_way():
    score = physical(DOOR, cupboard(hinge(sign=1.0)))
    assert score.pooled["opens_right_way"] == (0.0,)
    assert score.pooled["axis_angle_deg"] == pytest.approx((0.0,))
    expected = iou_of([reach(2.0 * 1.5 * share) for share in STATES])
    assert score.values["articulated_iou"] == pytest.approx(expected, abs=0.01)


def test_half_the_range():
    score = physical(DOOR, cupboard(hinge(upper=0.75)))
    assert score.pooled["range_error_rad"] == pytest.approx((0.75,))
    assert score.pooled["opens_right_way"] == (1.0,)
    for tolerance, name in ((0.05, "articulated_iou"), (0.02, "articulated_iou_strict")):
        expected = iou_of([reach(0.75 * share, tolerance) for share in STATES])
        assert score.values[name] == pytest.approx(expected, abs=0.015)


def test_a_drawer_taken_for_a_door():
    score = physical(cupboard(rail()), DOOR)
    assert score.pooled["type_accuracy"] == (0.0,)
    assert score.pooled["recall"] == (1.0,)
    for name in ("axis_angle_deg", "axis_offset", "range_error_size"):
        assert not score.pooled[name]
    assert score.pooled["opens_right_way"] == (1.0,)
    assert score.values["articulated_iou"] < 0.15


def test_a_knob_that_hardly_moves_is_not_as_good_as_one_that_stays():
    """Turned by a fifth it moves by less than the tolerance, but wrongly is still wrong."""
    small = cupboard(replace(hinge(upper=0.04), origin=np.array([0.5, 0.0, 0.0])))
    backwards = cupboard(replace(hinge(upper=0.04, sign=1.0), origin=np.array([0.5, 0.0, 0.0])))
    assert physical(small, small).values["articulated_iou"] == pytest.approx(1.0)
    assert physical(small, backwards).values["articulated_iou"] < 0.2


def test_an_open_door_that_is_said_to_open_from_here_goes_too_far():
    """Seen at half its range, a prediction of [0, 1.5] is off by half of it in every state."""
    seen = posed(DOOR, {"joint": 0.75})
    guess = replace(seen, joints=(replace(seen.joints[0], lower=0.0, upper=1.5),))
    assert physical(seen, seen).values["articulated_iou"] == pytest.approx(1.0)
    size = 1.0 + np.sin(0.75)  # from the wall to the door's edge
    expected = iou_of([reach(0.75, 0.05 * size)] * 4)
    assert physical(seen, guess).values["articulated_iou"] == pytest.approx(expected, abs=0.01)


def test_other_faces_are_refused():
    other = Articulation(DOOR.mesh.submesh([0, 1]), (Part("base", np.arange(2)),), (), "x")
    with pytest.raises(ValueError, match="2 predicted faces for 6400 true ones"):
        physical(DOOR, other)


@settings(max_examples=10)
@given(yaw=st.floats(-3.0, 3.0), seed=st.integers(0, 99), scale=st.floats(0.1, 10.0))
def test_neither_heading_nor_size_nor_the_order_of_faces_matters(yaw, seed, scale):
    def seen(articulation):
        matrix = np.diag([scale, scale, scale, 1.0])
        grown = tuple(
            replace(j, origin=j.origin * scale, **({} if j.turns else {"upper": j.upper * scale}))
            for j in articulation.joints
        )
        sized = replace(articulation, mesh=articulation.mesh.transformed(matrix), joints=grown)
        return merged(turned(sized, yaw), np.random.default_rng(seed))

    truth = DOOR
    guess = cupboard(replace(hinge(upper=1.2), origin=np.array([0.13, 0.0, 0.0])))
    # Size is that of the box, which a turn about the vertical changes; here it is undone.
    plain = physical(truth, guess)
    moved = physical(seen(truth), seen(guess))
    assert moved.values["part_miou"] == pytest.approx(plain.values["part_miou"])
    for name in ("recall", "axis_angle_deg", "range_error_rad", "opens_right_way"):
        assert moved.pooled[name] == pytest.approx(plain.pooled[name], abs=1e-5)


def tilted(degrees):
    """About the middle of the front, so that only the angle is wrong there."""
    angle = np.radians(degrees)
    axis = np.array([np.sin(angle), 0.0, np.cos(angle)])
    return cupboard(replace(hinge(), axis=axis, origin=np.array([0.0, 0.0, 0.5])))


def endless(sign):
    """Turns without ends."""
    return cupboard(hinge(0.0, np.pi, sign, -np.pi, JointKind.CONTINUOUS))


def right(*wanted):
    """Return the figures of a true moving part in their order; ``None``: it has none."""
    return {name: () if w is None else (w,) for name, w in zip(NAMES, wanted, strict=True)}


NO_ENDS = {"opens_right_way": (), "range_error_rad": ()}
#: Truth, prediction and figures, by the name of the case. The longest side is 1 m.
SCORES = {
    "the door itself": (
        DOOR,
        DOOR,
        right(1, 1, 1, 1, 1)
        | dict.fromkeys(("part_miou", "articulated_iou", "articulated_iou_strict"), 1)
        | dict.fromkeys(("recall", "precision", "type_accuracy", "opens_right_way"), (1,))
        | dict.fromkeys(("axis_angle_deg", "axis_offset", "range_error_rad"), (0,))
        | {"left_fixed": (0,), "still_moved": (0,), "range_error_size": ()},
    ),
    # Every point is at least 1 - cos(angle) from where it should be, 0.07 m in the first state.
    "a hinge on the wrong side opens the right way": (
        DOOR,
        cupboard(hinge(x=1.0, sign=1.0)),
        right(1, 1, 0, 0, 0)
        | {"part_miou": 1, "articulated_iou": 0, "opens_right_way": (1,)}
        | {"axis_offset": (1,), "axis_angle_deg": (0,)},
    ),
    "found and left where it is": (
        DOOR,
        cupboard(stuck()),
        right(0, 0, 0, 0, 0)
        | {"part_miou": 1, "articulated_iou": 0, "articulated_iou_strict": 0}
        | {"recall": (0,), "precision": (), "left_fixed": (1,), "type_accuracy": (0,)},
    ),
    "a carrier is no part of its own": (
        turning_drawer(),
        turning_drawer(),
        right(1, 1, 1, 1, 1)
        | {"recall": (1,), "precision": (1,), "articulated_iou": 1, "type_accuracy": (1,)}
        | {"range_error_rad": (0,), "range_error_size": (0,)},
    ),
    "a single part covers one of two equal ones by half": (
        DOOR,
        in_one_piece(DOOR),
        right(0, 0, 0, 0, 0) | {"part_miou": 0.375, "articulated_iou": 0},
    ),
    "something still that is said to move": (
        in_one_piece(DOOR),
        DOOR,
        {"precision": (0,), "recall": (), "still_moved": (1,)},
    ),
    "the range of a drawer is measured in sizes": (
        DRAWER,
        cupboard(rail(0.2)),
        {"range_error_size": (0.3,), "articulated_iou": 0},
    ),
    "which way a joint without ends points means nothing": (
        endless(-1.0),
        endless(1.0),
        NO_ENDS | {"articulated_iou": 1, "axis_angle_deg": (0,)},
    ),
    "all the way round with and without ends": (
        cupboard(hinge(upper=2.0 * np.pi)),
        endless(-1.0),
        NO_ENDS | {"articulated_iou": 1, "type_accuracy": (1,)},
    ),
    "a turn without its slide": (turning_drawer(), DOOR, {"type_accuracy": (0,)}),
    "a slide has no place": (DRAWER, DRAWER, right(1, 1, None, None, 1)),
    "1 cm beside": (DOOR, cupboard(hinge(0.01)), right(1, 1, 1, 1, 1)),
    "3 cm beside": (DOOR, cupboard(hinge(0.03)), right(1, 1, 1, 0, 1)),
    "6 cm beside": (DOOR, cupboard(hinge(0.06)), right(1, 1, 0, 0, 0)),
    "tilted": (DOOR, tilted(4.9), right(1, 1, 1, 1, 1) | {"axis_angle_deg": (4.9,)}),
    "tilted the other way": (DOOR, tilted(-4.9), right(1, 1, 1, 1, 1) | {"axis_angle_deg": (4.9,)}),
    "tilted too far": (DOOR, tilted(5.1), right(1, 0, 1, 1, 0)),
    "door taken for a drawer": (DOOR, DRAWER, right(0, 0, 0, 0, 0)),
    "drawer taken for a door": (DRAWER, DOOR, right(0, 0, None, None, 0)),
    "half of it": (turning_drawer(), cupboard(hinge(0.03)), right(0, 1, 1, 0, 0)),
}


@pytest.mark.parametrize(("truth", "predicted", "figures"), SCORES.values(), ids=SCORES)
def test_what_a_prediction_scores(truth, predicted, figures):
    score = physical(truth, predicted)
    found = {**score.values, **score.pooled}
    for name, wanted in figures.items():
        assert found[name] == pytest.approx(wanted, abs=1e-6), name
