"""What is no part of its own belongs to what it lies on; of guesses the small go first."""

import numpy as np
import trimesh

from asset_factory.factory.articulation import Articulation, Joint, Part
from asset_factory.factory.manufacture.lying import lying_on
from asset_factory.factory.manufacture.plan import Plan, as_planned, dispensable_joints
from asset_factory.factory.mesh import Mesh, concatenate


def cupboard(badge_confidence=0.9):
    """A body, a door in front of it, and a badge on the door that is taken for a part."""
    boxes = [
        ((0.0, 0.0, 0.5), (0.8, 0.6, 1.0)),
        ((0.0, -0.32, 0.5), (0.8, 0.03, 1.0)),
        ((0.1, -0.34, 0.7), (0.1, 0.01, 0.1)),
    ]
    meshes = []
    for center, size in boxes:
        made = trimesh.creation.box(extents=size)
        meshes.append(Mesh.from_triangles(made.vertices + np.array(center), made.faces))
    parts = tuple(
        Part(name, np.arange(12 * number, 12 * number + 12))
        for number, name in enumerate(("body", "door", "badge"))
    )
    hinge = {"axis": [0, 0, -1], "lower": 0.0, "upper": 1.5}
    joints = (
        Joint("door_hinge", "revolute", 0, 1, origin=[-0.4, -0.3, 0.5], confidence=0.5, **hinge),
        Joint(
            "badge_hinge",
            "revolute",
            0,
            2,
            origin=[0.1, -0.34, 0.7],
            confidence=badge_confidence,
            **hinge,
        ),
    )
    return Articulation(concatenate(meshes), parts, joints, "test")


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
