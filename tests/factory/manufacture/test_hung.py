"""Levers turn in a round seat, knobs and buttons in a pit; what is hung wrongly gets none."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from held_parts import (
    CONFIG,
    PAIR,
    box,
    cut,
    cut_free,
    cylinder,
    deepest,
    hulls_of,
    mesh_of,
    require_refused,
)

from asset_factory.factory.articulation import Joint, rotation_about
from asset_factory.factory.manufacture.separate.budget import SeenSurface
from asset_factory.factory.manufacture.separate.hung import well_hung

RADIUS, ARM = 0.05, 0.32
UP = np.array([0.0, 0.0, 1.0])
ALONG = np.array([1.0, 0.0, 0.0])
INWARD = np.array([0.0, 1.0, 0.0])

#: A lever on the hollow top of a post: a hub, and an arm to one side of it.
HUB = cylinder(RADIUS, 0.3, 0.36)
LEVER = [HUB, box((0.0, -0.02, 0.33), (ARM, 0.02, 0.36))]
COLLAR = cylinder(RADIUS + 0.02, 0.28, 0.31, sections=40)
POST = [cylinder(0.04, 0.0, 0.28), COLLAR]
SWING = Joint("turn", "revolute", 0, 1, UP, [0.0, 0.0, 0.33], 0.0, np.pi / 2.0)


def surface_of(solids):
    return SeenSurface.of(mesh_of(solids))


def test_a_lever_on_a_collar_is_well_hung_and_beside_it_is_not():
    surface, post = surface_of(LEVER), hulls_of(POST)
    assert well_hung(surface, SWING, post, CONFIG)
    # A third of the hub's radius, and a little more.
    for side in (ALONG, -ALONG):
        beside = replace(SWING, origin=SWING.origin + 0.025 * side)
        assert not well_hung(surface, beside, post, CONFIG)
    crooked = rotation_about(ALONG, np.radians(5.0)) @ UP
    assert not well_hung(surface, replace(SWING, axis=crooked), post, CONFIG)


def test_an_arm_that_touches_nothing_around_its_axis_is_not_well_hung():
    bar = surface_of([box((-0.1, -0.02, 0.31), (ARM, 0.02, 0.36))])
    assert not well_hung(bar, SWING, hulls_of(POST), CONFIG)
    assert not well_hung(surface_of(LEVER), SWING, (), CONFIG)


def test_what_is_alike_on_all_sides_of_its_axis_turns_about_its_middle():
    assert well_hung(surface_of([HUB]), SWING, (), CONFIG)


#: Something of the post that the lever's arm passes 8 mm deep on its way.
STOP = box((-0.02, 0.1, 0.28), (0.02, 0.14, 0.338))


def test_what_a_lever_scrapes_on_its_way_is_cut_back():
    _, _, result = cut_free([*POST, STOP], LEVER, SWING)
    assert 0.005 < max(each.deepest_m for each in result.trimmed[PAIR]) < CONFIG.scraped_m


SHIFT = 0.05 * 0.7
WRONG_LEVERS = {
    "shifted along its arm": replace(SWING, origin=SWING.origin + SHIFT * ALONG),
    "shifted away from it": replace(SWING, origin=SWING.origin - SHIFT * ALONG),
    "shifted across": replace(SWING, origin=SWING.origin + SHIFT * np.array([0.0, 1.0, 0.0])),
    "tilted": replace(SWING, axis=rotation_about(ALONG, -np.radians(10.0)) @ UP),
    "tilted the other way": replace(SWING, axis=rotation_about(ALONG, np.radians(10.0)) @ UP),
    "lying": replace(SWING, axis=np.array([0.0, 1.0, 0.0])),
}


def test_what_a_long_arm_passes_between_two_poses_is_cut_too():
    # Its end goes 26 mm in a step; it is 8 mm thick, the fin half a step further 5.
    angle = 10.5 * np.pi / 2.0 / (CONFIG.poses - 1)
    fin = box((0.76, -0.0025, 0.095), (0.8, 0.0025, 0.2))
    fin.apply_transform(trimesh.transformations.rotation_matrix(angle, UP))
    arm = box((0.0, -0.004, 0.0), (0.8, 0.004, 0.1))
    turn = replace(SWING, origin=np.zeros(3))
    cut_free([box((-0.2, -0.2, -0.1), (0.9, 0.9, -0.05)), fin], [arm], turn, poses=900)


@pytest.mark.parametrize("share", np.linspace(0.0, 0.8, 5))
def test_what_leaves_its_frame_keeps_the_distance_that_engines_feel(share):
    # Its round end passes a round post at 1.3 mm, in the first tenth of its way.
    end = cylinder(0.002, 0.0, 0.1)
    end.apply_translation([0.8, 0.0, 0.0])
    post = cylinder(0.002, 0.0, 0.1)
    post.apply_translation([0.8 + 0.004 + 0.0013, 0.0, 0.0])
    angle = 0.1 + share * 0.005
    post.apply_transform(trimesh.transformations.rotation_matrix(angle, UP))
    arm = box((0.0, -0.002, 0.0), (0.8, 0.002, 0.1))
    floor = box((-0.2, -0.2, -0.1), (0.9, 0.9, -0.05))
    tree, _, result = cut([floor, post], [arm, end], replace(SWING, origin=np.zeros(3)))
    assert result.refused == {}
    assert -deepest(tree, result, poses=800, gap=CONFIG.clearance_m, share=0.1) > 0.0018


#: A solid body whose front is at y = 0, and how wide it is.
SIZE = 1.0
BODY = [box((-SIZE / 2, 0.0, -SIZE / 2), (SIZE / 2, 0.6, SIZE / 2))]


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


WRONG_TURNS = {
    "shifted": replace(TURN, origin=0.05 * SIZE * ALONG),
    "tilted": replace(TURN, axis=rotation_about(ALONG, np.radians(10.0)) @ INWARD),
    "flipped end over end": replace(TURN, axis=ALONG),
}
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
    "to the side": replace(PRESS, axis=ALONG),
    "tilted": replace(PRESS, axis=rotation_about(ALONG, np.radians(10.0)) @ INWARD),
    "tilted down": replace(PRESS, axis=rotation_about(ALONG, -np.radians(10.0)) @ INWARD),
    "tilted sideways": replace(PRESS, axis=rotation_about(UP, np.radians(10.0)) @ INWARD),
}
#: A small flap, sunk in the front and hinged at its front edge.
FLAP = box((0.0, -0.002, 0.0), (0.16, 0.018, 0.1))
HINGE = Joint("hinge", "revolute", 0, 1, [0, 0, -1], [0.0, -0.002, 0.0], 0.0, 1.5)
WRONG_FLAPS = {
    "flipped": replace(HINGE, axis=-HINGE.axis),
    "limits swapped": replace(HINGE, lower=-1.5, upper=0.0),
}


def test_a_flap_in_a_solid_body_opens_outwards():
    assert cut(BODY, [FLAP], HINGE)[2].refused == {}


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
RING_M = 0.1
INNER = RING_M * np.cos(np.pi / SIDES) + 0.001
WIDTH = INNER * np.tan(np.pi / SIDES)
FLOOR = box((-0.3, -0.3, -0.2), (0.3, 0.3, -0.06))
KNOB = trimesh.creation.cylinder(RING_M, 0.06, sections=SIDES)
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
    "shifted": replace(ROUND, origin=0.05 * 0.7 * ALONG),
    "tilted": replace(
        ROUND, axis=rotation_about(ALONG, np.radians(10.0)) @ UP, lower=0.0, upper=0.5
    ),
    "lying": replace(ROUND, axis=ALONG),
}
WRONG = {
    "knob": (BODY, [knob(0.06)], WRONG_TURNS),
    "button": (BODY, [BUTTON], WRONG_SLIDES),
    "flap": (BODY, [FLAP], WRONG_FLAPS),
    "knob in a ring": (ring(), [KNOB], OFF_THE_RING),
    "lever": ([*POST, STOP], LEVER, WRONG_LEVERS),
}


@pytest.mark.parametrize(
    ("thing", "how"), [(thing, how) for thing, (*_, joints) in WRONG.items() for how in joints]
)
def test_what_is_hung_wrongly_is_not_cut_free(thing, how):
    body, mover, joints = WRONG[thing]
    require_refused(body, mover, joints[how])
