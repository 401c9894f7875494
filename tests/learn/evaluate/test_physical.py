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


def knob(sign=-1.0):
    """The front as a knob that turns a little about an axis in its middle."""
    return cupboard(replace(hinge(upper=0.04, sign=sign), origin=np.array([0.5, 0.0, 0.0])))


ENDLESS = {"kind": JointKind.CONTINUOUS, "lower": -np.pi, "upper": np.pi}
NO_END = {"articulated_iou": 1.0, "type_accuracy": (1.0,), "axis_angle_deg": (0.0,)}
NO_END |= {"opens_right_way": (), "range_error_rad": ()}
#: The truth, what is predicted, and figures of that: over all faces, or of every joint or part.
FIGURES = {
    "the truth": (
        DOOR,
        DOOR,
        dict.fromkeys(("part_miou", "articulated_iou", "articulated_iou_strict"), 1.0)
        | dict.fromkeys(("recall", "precision", "type_accuracy", "opens_right_way"), (1.0,))
        | dict.fromkeys(("axis_angle_deg", "axis_offset", "range_error_rad"), (0.0,))
        | {"left_fixed": (0.0,), "still_moved": (0.0,), "range_error_size": ()},
    ),
    # Every point is at least 1 - cos(angle) away from where it should be, 0.07 m in the first
    # state.
    "a hinge on the wrong side that opens the right way": (
        DOOR,
        cupboard(hinge(x=1.0, sign=1.0)),
        {"part_miou": 1.0, "articulated_iou": 0.0, "axis_offset": (1.0,)}
        | {"axis_angle_deg": (0.0,), "opens_right_way": (1.0,), "joint_right": (0.0,)},
    ),
    "a hinge that turns the wrong way": (
        DOOR,
        cupboard(hinge(sign=1.0)),
        {"opens_right_way": (0.0,), "axis_angle_deg": (0.0,)},
    ),
    "half the range": (
        DOOR,
        cupboard(hinge(upper=0.75)),
        {"range_error_rad": (0.75,), "opens_right_way": (1.0,)},
    ),
    "an axis that is tilted and points the other way": (
        DOOR,
        cupboard(replace(hinge(), axis=np.array([np.sin(0.2), 0.0, np.cos(0.2)]))),
        {"axis_angle_deg": (np.degrees(0.2),)},
    ),
    "a drawer taken for a door": (
        DRAWER,
        DOOR,
        {"type_accuracy": (0.0,), "recall": (1.0,), "opens_right_way": (1.0,)}
        | dict.fromkeys(("axis_angle_deg", "axis_offset", "range_error_size"), ()),
    ),
    "the range of a drawer, in sizes": (
        DRAWER,
        cupboard(rail(0.2)),
        {"range_error_size": (0.3,), "articulated_iou": 0.0},
    ),
    "a part found and left where it is": (
        DOOR,
        cupboard(stuck()),
        {"part_miou": 1.0, "articulated_iou": 0.0, "articulated_iou_strict": 0.0}
        | {"recall": (0.0,), "precision": (), "left_fixed": (1.0,), "type_accuracy": (0.0,)},
    ),
    # It covers one of two equal ones by half.
    "a single part": (DOOR, in_one_piece(DOOR), {"part_miou": 0.375, "articulated_iou": 0.0}),
    "something still that is said to move": (
        in_one_piece(DOOR),
        DOOR,
        {"precision": (0.0,), "recall": (), "still_moved": (1.0,)},
    ),
    "a knob that hardly moves": (knob(), knob(), {"articulated_iou": 1.0}),
    "joints without ends that point opposite ways": (
        cupboard(hinge(sign=-1.0, **ENDLESS)),
        cupboard(hinge(sign=1.0, **ENDLESS)),
        NO_END,
    ),
    "all the way round, with and without ends": (
        cupboard(hinge(upper=2.0 * np.pi)),
        cupboard(hinge(**ENDLESS)),
        NO_END,
    ),
    "a carrier, which is no part of its own": (
        turning_drawer(),
        turning_drawer(),
        {"recall": (1.0,), "precision": (1.0,), "type_accuracy": (1.0,), "articulated_iou": 1.0}
        | {"range_error_rad": (0.0,), "range_error_size": (0.0,)},
    ),
    "half of what turns and slides": (turning_drawer(), DOOR, {"type_accuracy": (0.0,)}),
}


@pytest.mark.parametrize("case", FIGURES)
def test_a_prediction_has_the_figures_of_its_closed_form(case):
    truth, predicted, wanted = FIGURES[case]
    score = physical(truth, predicted)
    found = {**score.values, **score.pooled}
    for name, value in wanted.items():
        assert found[name] == pytest.approx(value, abs=1e-6), name


def test_what_opens_otherwise_is_right_as_far_as_it_gets_where_it_should():
    turned_back = physical(DOOR, cupboard(hinge(sign=1.0))).values["articulated_iou"]
    expected = iou_of([reach(2.0 * 1.5 * share) for share in STATES])
    assert turned_back == pytest.approx(expected, abs=0.01)
    half = physical(DOOR, cupboard(hinge(upper=0.75)))
    for tolerance, name in ((0.05, "articulated_iou"), (0.02, "articulated_iou_strict")):
        expected = iou_of([reach(0.75 * share, tolerance) for share in STATES])
        assert half.values[name] == pytest.approx(expected, abs=0.015)
    assert physical(DRAWER, DOOR).values["articulated_iou"] < 0.15
    # Turned by a fifth a knob moves by less than the tolerance, but wrongly is still wrong.
    assert physical(knob(), knob(sign=1.0)).values["articulated_iou"] < 0.2


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
