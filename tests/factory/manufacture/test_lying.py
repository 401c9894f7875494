"""What is no part of its own belongs to what it lies on; of guesses the small go first."""

from plain_solids import box_between, parted

from asset_factory.factory.articulation import Joint
from asset_factory.factory.manufacture.plan import Plan, as_planned, dispensable_joints, lying_on


def cupboard():
    """A body, a door in front of it, and a badge on the door that is taken for a part."""
    boxes = {
        "body": [box_between((-0.4, -0.3, 0.0), (0.4, 0.3, 1.0))],
        "door": [box_between((-0.4, -0.335, 0.0), (0.4, -0.305, 1.0))],
        "badge": [box_between((0.05, -0.345, 0.65), (0.15, -0.335, 0.75))],
    }

    def hinge(name, child, origin, confidence):
        motion = {"axis": [0, 0, -1], "origin": origin, "lower": 0.0, "upper": 1.5}
        return Joint(name, "revolute", 0, child, **motion, confidence=confidence)

    door = hinge("door_hinge", 1, [-0.4, -0.3, 0.5], 0.5)
    return parted(boxes, door, hinge("badge_hinge", 2, [0.1, -0.34, 0.7], 0.9))


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
