"""Doors of rooms, fridges and machines, and drawers in one piece."""

import numpy as np
import pytest
from one_piece import mesh_of
from plain_solids import box_between as box
from plain_solids import carcass
from stated_parts import block
from test_geometric import articulate

from asset_factory.factory.articulation import JointKind

FRAME = [
    box((0.0, 0.0, 0.0), (0.06, 0.12, 2.1)),
    box((0.94, 0.0, 0.0), (1.0, 0.12, 2.1)),
    box((0.06, 0.0, 2.04), (0.94, 0.12, 2.1)),
]
LEAF = box((0.065, 0.01, 0.005), (0.935, 0.05, 2.035))
KNOB = box((0.85, -0.04, 1.0), (0.9, 0.01, 1.05))


def test_a_room_door_hinges_across_from_its_knob_and_opens_to_its_flush_side():
    articulation = articulate(*FRAME, LEAF, KNOB)
    (joint,) = articulation.joints
    assert joint.kind is JointKind.REVOLUTE
    assert np.allclose(joint.axis, [0, 0, -1])
    assert joint.origin[0] == pytest.approx(0.065)
    assert np.array_equal(articulation.parts[1].faces, np.arange(36, 60))


def test_a_pair_of_leaves_opens_away_from_each_other():
    left = box((0.065, 0.01, 0.005), (0.499, 0.05, 2.035))
    right = box((0.501, 0.01, 0.005), (0.935, 0.05, 2.035))
    joints = articulate(*FRAME, left, right).joints
    found = sorted((round(float(j.origin[0]), 3), round(float(j.axis[2]))) for j in joints)
    assert found == [(0.065, -1), (0.935, 1)]


def test_a_picture_on_its_back_board_and_a_leaf_without_a_frame_stay():
    board = box((0.0, 0.05, 0.0), (1.0, 0.07, 0.8))
    picture = box((0.1, 0.03, 0.1), (0.9, 0.05, 0.7))
    assert articulate(board, picture).joints == ()
    assert articulate(LEAF, KNOB).joints == ()


@pytest.mark.parametrize(("thickness", "degrees"), [(0.06, 180.0), (0.02, 90.0)])
def test_a_thick_upright_door_opens_further_than_a_thin_one(thickness, degrees):
    door = box((0.001, -thickness, 0.001), (0.599, -0.001, 1.599))
    grip = box((0.53, -thickness - 0.04, 0.6), (0.55, -thickness - 0.001, 1.1))
    (joint,) = articulate(*carcass(0.6, 0.6, 1.6), door, grip).joints
    assert np.degrees(joint.upper) == pytest.approx(degrees, abs=5.0)


def test_a_bar_on_two_posts_is_a_handle():
    door = box((0.001, -0.02, 0.001), (0.399, -0.001, 0.399))
    posts = [box((0.34, -0.09, z), (0.36, -0.021, z + 0.02)) for z in (0.08, 0.3)]
    bar = box((0.335, -0.12, 0.06), (0.365, -0.089, 0.34))
    articulation = articulate(*carcass(0.4, 0.5, 0.4), door, *posts, bar)
    assert len(articulation.parts[1].faces) == 48
    assert articulation.joints[0].axis[2] == pytest.approx(-1.0)


def test_shelves_behind_a_door_with_a_side_handle_do_not_make_it_a_drawer():
    door = box((0.001, -0.03, 0.001), (0.599, -0.001, 0.799))
    grip = box((0.55, -0.06, 0.3), (0.565, -0.031, 0.5))
    inside = [
        box((0.03, -0.001, 0.1), (0.04, 0.45, 0.4)),
        box((0.56, -0.001, 0.1), (0.57, 0.45, 0.4)),
        box((0.04, -0.001, 0.1), (0.56, 0.45, 0.11)),
    ]
    (joint,) = articulate(*carcass(0.6, 0.5, 0.8), door, grip, *inside).joints
    assert joint.kind is JointKind.REVOLUTE


def tub(low, high, grip):
    """A drawer as one surface, open at the top; perhaps with a bump fused to its front."""
    w = 0.01
    inside = block(np.add(low, w), (high[0] - w, high[1] - w, high[2] + w))
    solid = block(low, high) - inside
    if grip:
        x, _, z = np.add(low, high) / 2.0
        solid += block((x - 0.05, low[1] - 0.06, z - 0.01), (x + 0.05, low[1] + w, z + 0.01))
    return mesh_of(solid, edge=1.0)


@pytest.mark.parametrize("grip", [True, False])
def test_a_lone_drawer_in_one_piece_needs_a_grip(grip):
    drawer = tub((0.03, 0, 0.03), (0.57, 0.4, 0.15), grip)
    joints = articulate(*carcass(0.6, 0.5, 0.2), drawer).joints
    assert [j.kind for j in joints] == ([JointKind.PRISMATIC] if grip else [])
    if grip:
        assert np.allclose(joints[0].axis, [0, -1, 0])
