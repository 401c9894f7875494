"""A door that is hung at its front edge turns clear of the frame around it."""

import numpy as np
import pytest
from modelled_furniture import board
from plain_solids import parted

from asset_factory.factory.articulate.locate import located
from asset_factory.factory.articulation import Joint, JointKind, rotation_about
from asset_factory.factory.geometry.posing import rotated
from asset_factory.factory.manufacture.hinges import at_front_edge
from asset_factory.factory.manufacture.plan import Plan, as_planned, dispensable_joints

#: Door within a frame: from here to there, 2 cm thick, 1 mm of air at its left.
LEFT = 0.021
RIGHT = 0.379
THICK = 0.02


def inset_door(**changed):
    """A frame's left post and the door beside it, its hinge at the back, handle at the right."""
    post = board((0.0, 0.0, 0.0), (0.02, 0.4, 0.6))
    door = board((LEFT, 0.0, 0.0), (RIGHT, THICK, 0.6))
    handle = board((0.33, -0.03, 0.2), (0.35, 0.0, 0.4))
    place = ([0, 0, -1], [LEFT, THICK, 0.3])
    stated = {"upper": 1.5, "confidence": 0.9, "kind": JointKind.REVOLUTE, **changed}
    hinge = Joint("hinge", stated.pop("kind"), 0, 1, *place, **stated)
    return located(parted({"base": [post], "door": [door, handle]}, hinge))


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
    door = inset_door()
    rotation = rotation_about([0.0, 0.0, 1.0], turn)
    turned = rotated(door, rotation)
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
