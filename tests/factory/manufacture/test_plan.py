"""Doors are hung at their front edges; what is no part of its own goes to what it lies on."""

from dataclasses import replace

import numpy as np
import pytest
from plain_solids import box_between, parted

from asset_factory.factory.articulate.locate import located
from asset_factory.factory.articulation import Joint, JointKind, rotation_about
from asset_factory.factory.geometry.posing import rotated
from asset_factory.factory.manufacture.hinges import at_front_edge
from asset_factory.factory.manufacture.plan import Plan, as_planned, dispensable_joints, lying_on

#: Door within a frame: from here to there, 2 cm thick, 1 mm of air at its left.
LEFT = 0.021
RIGHT = 0.379
THICK = 0.02


def inset_door(**changed):
    """A frame's left post and the door beside it, its hinge at the back, handle at the right."""
    post = box_between((0.0, 0.0, 0.0), (0.02, 0.4, 0.6))
    door = box_between((LEFT, 0.0, 0.0), (RIGHT, THICK, 0.6))
    handle = box_between((0.33, -0.03, 0.2), (0.35, 0.0, 0.4))
    place = ([0, 0, -1], [LEFT, THICK, 0.3])
    hinge = Joint("hinge", JointKind.REVOLUTE, 0, 1, *place, upper=1.5, confidence=0.9)
    return located(parted({"base": [post], "door": [door, handle]}, replace(hinge, **changed)))


def farthest_left(door, joint):
    """Of the panel's corners along its way [m]."""
    panel = door.mesh.submesh(np.arange(12, 24))
    corners = panel.vertices - joint.origin
    turns = [rotation_about(joint.axis, angle) for angle in np.linspace(0.0, joint.upper, 40)]
    return float(min((corners @ turn.T + joint.origin)[:, 0].min() for turn in turns))


def test_at_its_back_edge_an_inset_door_turns_into_the_frame_at_its_front_edge_not():
    door = inset_door()
    (given,) = door.joints
    hung = at_front_edge(door, given)
    assert hung.origin == pytest.approx([LEFT, 0.0, 0.3])
    assert farthest_left(door, given) == pytest.approx(LEFT - THICK, abs=1e-3)
    assert farthest_left(door, hung) == pytest.approx(LEFT)
    assert at_front_edge(door, hung) is None


@pytest.mark.parametrize("turn", [0.0, np.pi / 2.0, np.pi, -np.pi / 2.0])
def test_the_front_edge_is_found_whichever_way_the_door_faces(turn):
    rotation = rotation_about([0.0, 0.0, 1.0], turn)
    turned = rotated(inset_door(), rotation)
    hung = at_front_edge(turned, turned.joints[0])
    assert hung.origin == pytest.approx(rotation @ [LEFT, 0.0, 0.3])


@pytest.mark.parametrize("changed", [{"kind": JointKind.PRISMATIC}, {"lower": -1.5}])
def test_what_slides_or_swings_both_ways_has_no_front_edge(changed):
    door = inset_door(**changed)
    assert at_front_edge(door, door.joints[0]) is None


def test_a_plan_rehangs_guessed_hinges_only():
    door = inset_door()
    assert dispensable_joints(door, 0.15).hinges == {"hinge"}
    assert not dispensable_joints(inset_door(confidence=None), 0.15).hinges
    rehung = as_planned(door, Plan(rehung=frozenset({"hinge"})))
    assert rehung.joints[0].origin == pytest.approx([LEFT, 0.0, 0.3])


def cupboard():
    """A body, a door in front of it, and a badge on the door that is taken for a part."""
    boxes = {
        "body": [box_between((-0.4, -0.3, 0.0), (0.4, 0.3, 1.0))],
        "door": [box_between((-0.4, -0.335, 0.0), (0.4, -0.305, 1.0))],
        "badge": [box_between((0.05, -0.345, 0.65), (0.15, -0.335, 0.75))],
    }
    place = ([0, 0, -1], [-0.4, -0.3, 0.5])
    door = Joint("door_hinge", "revolute", 0, 1, *place, 0.0, 1.5, confidence=0.5)
    badge = replace(door, name="badge_hinge", child=2, origin=[0.1, -0.34, 0.7], confidence=0.9)
    return parted(boxes, door, badge)


def test_a_badge_goes_with_the_door_that_it_lies_on_and_not_with_its_parent():
    whole = cupboard()
    assert lying_on(whole, {"badge_hinge"}) == {"badge_hinge": 1}
    left = as_planned(whole, Plan(given_up=frozenset({"badge_hinge"})))
    assert [part.name for part in left.parts] == ["body", "door"]
    assert len(left.parts[1].faces) == 24


def test_none_lies_on_what_goes_too():
    both = {"badge_hinge", "door_hinge"}
    assert lying_on(cupboard(), both) == {"door_hinge": 0, "badge_hinge": 0}
    assert lying_on(cupboard(), set()) == {}


def test_of_guesses_the_small_one_is_worth_less_though_it_is_surer():
    assert list(dispensable_joints(cupboard(), 0.01).guesses) == ["badge"]
    assert dispensable_joints(cupboard(), 0.01).joints == {"badge_hinge"}
