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


def test_the_truth_scores_full_marks():
    score = physical(DOOR, DOOR)
    for name in ("part_miou", "articulated_iou", "articulated_iou_strict"):
        assert score.values[name] == pytest.approx(1.0)
    for name in ("recall", "precision", "type_accuracy", "opens_right_way", "joint_right"):
        assert score.pooled[name] == (1.0,)
    for name in ("axis_angle_deg", "axis_offset", "range_error_rad", "left_fixed", "still_moved"):
        assert score.pooled[name] == pytest.approx((0.0,), abs=1e-6)
    assert score.pooled["range_error_size"] == ()


def test_a_hinge_on_the_wrong_side_opens_the_right_way_and_gets_nothing_where_it_belongs():
    score = physical(DOOR, cupboard(hinge(x=1.0, sign=1.0)))
    assert score.values["part_miou"] == pytest.approx(1.0)
    assert score.pooled["joint_right"] == (0.0,)
    assert score.pooled["axis_offset"] == pytest.approx((1.0,))
    assert score.pooled["axis_angle_deg"] == pytest.approx((0.0,))
    assert score.pooled["opens_right_way"] == (1.0,)
    # Every point is at least 1 - cos(angle) away from where it should be, 0.07 m in the first
    # state.
    assert score.values["articulated_iou"] == 0.0


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


def test_a_tilted_axis_is_off_by_its_angle_whichever_way_it_points():
    tilted = replace(hinge(), axis=np.array([np.sin(0.2), 0.0, np.cos(0.2)]))
    score = physical(DOOR, cupboard(tilted))
    assert score.pooled["axis_angle_deg"] == pytest.approx((np.degrees(0.2),))


def test_a_drawer_taken_for_a_door():
    score = physical(cupboard(rail()), DOOR)
    assert score.pooled["type_accuracy"] == (0.0,)
    assert score.pooled["recall"] == (1.0,)
    for name in ("axis_angle_deg", "axis_offset", "range_error_size"):
        assert not score.pooled[name]
    assert score.pooled["opens_right_way"] == (1.0,)
    assert score.values["articulated_iou"] < 0.15


def test_the_range_of_a_drawer_is_measured_in_sizes():
    score = physical(cupboard(rail(0.5)), cupboard(rail(0.2)))
    assert score.pooled["range_error_size"] == pytest.approx((0.3,))
    assert score.values["articulated_iou"] == 0.0


def test_a_part_found_and_left_where_it_is_scores_nothing_for_moving():
    score = physical(DOOR, cupboard(stuck()))
    assert score.values["part_miou"] == pytest.approx(1.0)
    assert score.values["articulated_iou"] == score.values["articulated_iou_strict"] == 0.0
    assert score.pooled["recall"] == (0.0,)
    assert score.pooled["precision"] == ()
    assert score.pooled["left_fixed"] == (1.0,)
    assert score.pooled["type_accuracy"] == (0.0,)


def test_a_single_part_covers_one_of_two_equal_ones_by_half():
    score = physical(DOOR, in_one_piece(DOOR))
    assert score.values["part_miou"] == pytest.approx(0.375)
    assert score.values["articulated_iou"] == 0.0


def test_something_still_that_is_said_to_move_is_wrong():
    score = physical(in_one_piece(DOOR), DOOR)
    assert score.pooled["precision"] == (0.0,)
    assert score.pooled["recall"] == ()
    assert score.pooled["still_moved"] == (1.0,)


def test_a_knob_that_hardly_moves_is_not_as_good_as_one_that_stays():
    """Turned by a fifth it moves by less than the tolerance, but wrongly is still wrong."""
    small = cupboard(replace(hinge(upper=0.04), origin=np.array([0.5, 0.0, 0.0])))
    backwards = cupboard(replace(hinge(upper=0.04, sign=1.0), origin=np.array([0.5, 0.0, 0.0])))
    assert physical(small, small).values["articulated_iou"] == pytest.approx(1.0)
    assert physical(small, backwards).values["articulated_iou"] < 0.2


def test_which_way_a_joint_without_ends_points_means_nothing():
    endless = {"kind": JointKind.CONTINUOUS, "lower": -np.pi, "upper": np.pi}
    score = physical(cupboard(hinge(sign=-1.0, **endless)), cupboard(hinge(sign=1.0, **endless)))
    assert score.values["articulated_iou"] == pytest.approx(1.0)
    assert score.pooled["opens_right_way"] == score.pooled["range_error_rad"] == ()
    assert score.pooled["axis_angle_deg"] == pytest.approx((0.0,))


def test_a_carrier_is_no_part_of_its_own():
    both = turning_drawer()
    score = physical(both, both)
    assert score.pooled["recall"] == score.pooled["precision"] == (1.0,)
    assert score.values["articulated_iou"] == pytest.approx(1.0)
    assert score.pooled["type_accuracy"] == (1.0,)
    assert len(score.pooled["range_error_rad"]) == len(score.pooled["range_error_size"]) == 1
    assert physical(both, DOOR).pooled["type_accuracy"] == (0.0,)


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


def test_a_knob_that_turns_all_the_way_round_is_the_same_with_and_without_ends():
    whole = cupboard(replace(hinge(), kind=JointKind.REVOLUTE, lower=0.0, upper=2.0 * np.pi))
    endless = cupboard(replace(hinge(), kind=JointKind.CONTINUOUS, lower=-np.pi, upper=np.pi))
    score = physical(whole, endless)
    assert score.values["articulated_iou"] == pytest.approx(1.0)
    assert score.pooled["type_accuracy"] == (1.0,)
    assert score.pooled["opens_right_way"] == score.pooled["range_error_rad"] == ()


def tilted(degrees):
    """About the middle of the front, so that only the angle is wrong there."""
    angle = np.radians(degrees)
    axis = np.array([np.sin(angle), 0.0, np.cos(angle)])
    return cupboard(replace(hinge(), axis=axis, origin=np.array([0.0, 0.0, 0.5])))


@pytest.mark.parametrize(
    ("truth", "predicted", "right"),
    [
        pytest.param(DOOR, DOOR, (1, 1, 1, 1, 1), id="the door itself"),
        pytest.param(DRAWER, DRAWER, (1, 1, None, None, 1), id="a slide has no place"),
        pytest.param(DOOR, in_one_piece(DOOR), (0, 0, 0, 0, 0), id="missed"),
        pytest.param(DOOR, cupboard(stuck()), (0, 0, 0, 0, 0), id="left where it is"),
        # The longest side is 1 m.
        pytest.param(DOOR, cupboard(hinge(0.01)), (1, 1, 1, 1, 1), id="1 cm beside"),
        pytest.param(DOOR, cupboard(hinge(0.03)), (1, 1, 1, 0, 1), id="3 cm beside"),
        pytest.param(DOOR, cupboard(hinge(0.06)), (1, 1, 0, 0, 0), id="6 cm beside"),
        pytest.param(DOOR, tilted(4.9), (1, 1, 1, 1, 1), id="tilted"),
        pytest.param(DOOR, tilted(-4.9), (1, 1, 1, 1, 1), id="tilted the other way"),
        pytest.param(DOOR, tilted(5.1), (1, 0, 1, 1, 0), id="tilted too far"),
        pytest.param(DOOR, DRAWER, (0, 0, 0, 0, 0), id="door taken for a drawer"),
        pytest.param(DRAWER, DOOR, (0, 0, None, None, 0), id="drawer taken for a door"),
        pytest.param(turning_drawer(), turning_drawer(), (1, 1, 1, 1, 1), id="turns and slides"),
        pytest.param(turning_drawer(), cupboard(hinge(0.03)), (0, 1, 1, 0, 0), id="half of it"),
    ],
)
def test_what_is_right_of_every_true_joint(truth, predicted, right):
    pooled = physical(truth, predicted).pooled
    wanted = [() if each is None else (float(each),) for each in right]
    assert [pooled[name] for name in NAMES] == wanted
