"""What is no part of its own belongs to what it lies on; of guesses the small go first."""

import numpy as np
from plain_solids import box_between

from asset_factory.factory.articulation import Articulation, Joint, Part
from asset_factory.factory.manufacture.plan import Plan, as_planned, dispensable_joints, lying_on
from asset_factory.factory.mesh import concatenate


def cupboard():
    """A body, a door in front of it, and a badge on the door that is taken for a part."""
    boxes = {
        "body": ((-0.4, -0.3, 0.0), (0.4, 0.3, 1.0)),
        "door": ((-0.4, -0.335, 0.0), (0.4, -0.305, 1.0)),
        "badge": ((0.05, -0.345, 0.65), (0.15, -0.335, 0.75)),
    }
    mesh = concatenate([box_between(*corners) for corners in boxes.values()])
    faces = np.arange(36).reshape(3, 12)
    parts = tuple(Part(name, own) for name, own in zip(boxes, faces, strict=True))

    def hinge(name, child, origin, confidence):
        motion = {"axis": [0, 0, -1], "origin": origin, "lower": 0.0, "upper": 1.5}
        return Joint(name, "revolute", 0, child, **motion, confidence=confidence)

    joints = (
        hinge("door_hinge", 1, [-0.4, -0.3, 0.5], 0.5),
        hinge("badge_hinge", 2, [0.1, -0.34, 0.7], 0.9),
    )
    return Articulation(mesh, parts, joints, "test")


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
