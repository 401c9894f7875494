"""What stands in a solid body gets a pit to turn and slide in; what is hung wrongly gets none."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from held_parts import PAIR, box, cut, cut_free, require_refused

from asset_factory.factory.articulation import Joint, rotation_about

#: A solid body whose front is at y = 0, and how wide it is.
SIZE = 1.0
BODY = [box((-SIZE / 2, 0.0, -SIZE / 2), (SIZE / 2, 0.6, SIZE / 2))]
INWARD = np.array([0.0, 1.0, 0.0])


def taken(before, after):
    """Share of the body's volume that went."""
    first, last = (sum(hull.volume for hull in pieces[0].hulls) for pieces in (before, after))
    return 1.0 - last / first


def knob(radius, sections=24):
    """A round knob, 30 mm before the front and 90 mm in the body, about the y axis."""
    made = trimesh.creation.cylinder(radius, 0.12, sections=sections)
    made.apply_transform(trimesh.geometry.align_vectors([0, 0, 1], INWARD))
    made.apply_translation([0.0, 0.03, 0.0])
    return made


TURN = Joint("turn", "revolute", 0, 1, INWARD, [0.0, 0.0, 0.0], -2.5, 2.5)


@pytest.mark.parametrize(("radius", "sections"), [(0.03, 4), (0.06, 24)])
def test_a_knob_that_stands_deep_in_a_body_turns_in_a_pit(radius, sections):
    _, before, result = cut_free(BODY, [knob(radius, sections)], TURN)
    assert result.pieces[1] is before[1]
    assert taken(before, result.pieces) < 0.03
    assert len(result.pieces[0].hulls) <= 12
    # How deep it lay in the body is told.
    assert result.hidden[PAIR] > 0.04


SIDE = np.array([1.0, 0.0, 0.0])
UP = np.array([0.0, 0.0, 1.0])
TWINS = {
    "shifted": replace(TURN, origin=0.05 * SIZE * SIDE),
    "tilted": replace(TURN, axis=rotation_about(SIDE, np.radians(10.0)) @ INWARD),
    "flipped end over end": replace(TURN, axis=SIDE),
}


@pytest.mark.parametrize("name", TWINS)
def test_a_knob_that_is_hung_wrongly_gets_none(name):
    require_refused(BODY, [knob(0.06)], TWINS[name])


BUTTON = box((-0.05, -0.03, -0.05), (0.05, 0.09, 0.05))
PRESS = Joint("press", "prismatic", 0, 1, INWARD, [0.0, 0.0, 0.0], 0.0, 0.025)


def test_a_button_is_pressed_into_a_pit_behind_it():
    _, before, result = cut_free(BODY, [BUTTON], PRESS)
    assert result.pieces[1] is before[1]
    assert taken(before, result.pieces) == pytest.approx(0.105**2 * 0.1175 / 0.6, rel=1e-3)


WRONG_SLIDES = {
    "deeper than it stands out": replace(PRESS, upper=0.04),
    "pulled out": replace(PRESS, axis=-INWARD),
    "limits swapped": replace(PRESS, lower=-PRESS.upper, upper=0.0),
    "to the side": replace(PRESS, axis=SIDE),
    "tilted": replace(PRESS, axis=rotation_about(SIDE, np.radians(10.0)) @ INWARD),
    "tilted down": replace(PRESS, axis=rotation_about(SIDE, -np.radians(10.0)) @ INWARD),
    "tilted sideways": replace(PRESS, axis=rotation_about(UP, np.radians(10.0)) @ INWARD),
}


@pytest.mark.parametrize("name", WRONG_SLIDES)
def test_what_is_no_button_gets_none(name):
    require_refused(BODY, [BUTTON], WRONG_SLIDES[name])


#: A small flap, sunk in the front and hinged at its front edge.
FLAP = box((0.0, -0.002, 0.0), (0.16, 0.018, 0.1))
HINGE = Joint("hinge", "revolute", 0, 1, [0, 0, -1], [0.0, -0.002, 0.0], 0.0, 1.5)


def test_a_flap_in_a_solid_body_opens_outwards_and_never_inwards():
    assert cut(BODY, [FLAP], HINGE)[2].refused == {}
    for wrong in (replace(HINGE, axis=-HINGE.axis), replace(HINGE, lower=-1.5, upper=0.0)):
        require_refused(BODY, [FLAP], wrong)


def test_what_would_take_much_of_the_body_gets_none():
    slim = [box((-0.0625, 0.0, -0.0625), (0.0625, 0.12, 0.0625))]
    assert PAIR in cut(slim, [knob(0.06)], TURN)[2].refused


def test_a_pit_does_not_open_what_can_be_seen_behind():
    # A hollow behind a front of 20 mm: the knob does not reach through, its travel would.
    front = [box((-0.5, 0.0, -0.5), (0.5, 0.02, 0.5))]
    button = box((-0.05, -0.03, -0.05), (0.05, 0.015, 0.05))
    assert PAIR in cut(front, [button], PRESS)[2].refused


#: A knob of eight sides, 1 mm from the ring of as many boards around it, over a floor.
SIDES = 8
RADIUS = 0.1
INNER = RADIUS * np.cos(np.pi / SIDES) + 0.001
WIDTH = INNER * np.tan(np.pi / SIDES)
FLOOR = box((-0.3, -0.3, -0.2), (0.3, 0.3, -0.06))
KNOB = trimesh.creation.cylinder(RADIUS, 0.06, sections=SIDES)
ROUND = Joint("turn", "revolute", 0, 1, UP, [0.0, 0.0, 0.0], -0.6, 0.6)


def ring():
    """The boards and the floor."""
    boards = []
    for angle in 2.0 * np.pi * (np.arange(SIDES) + 0.5) / SIDES:
        board = box((INNER, -WIDTH, -0.02), (INNER + 0.02, WIDTH, 0.0))
        boards.append(board.apply_transform(trimesh.transformations.rotation_matrix(angle, UP)))
    return [*boards, FLOOR]


def test_a_knob_in_a_ring_of_flat_boards_is_cut_free():
    cut_free(ring(), [KNOB], ROUND)


OFF_THE_RING = {
    "shifted": replace(ROUND, origin=0.05 * 0.7 * SIDE),
    "tilted": replace(
        ROUND, axis=rotation_about(SIDE, np.radians(10.0)) @ UP, lower=0.0, upper=0.5
    ),
    "lying": replace(ROUND, axis=SIDE),
}


@pytest.mark.parametrize("name", OFF_THE_RING)
def test_a_knob_that_turns_about_another_axis_than_its_ring_s_is_not_cut_free(name):
    require_refused(ring(), [KNOB], OFF_THE_RING[name])
