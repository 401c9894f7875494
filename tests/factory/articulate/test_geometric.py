"""Doors, drawers, lids from geometry alone: what opens is found, what does not stays rigid."""

from functools import cache

import numpy as np
import pytest
from plain_solids import box_between as box
from plain_solids import carcass

from asset_factory.factory.articulate.geometric import GeometricArticulator
from asset_factory.factory.articulation import JointKind, rotation_about
from asset_factory.factory.mesh import Mesh, concatenate
from asset_factory.learn.objects import make_object

CARCASS = carcass(0.6, 0.5, 0.8)
DOOR = box((0.001, -0.02, 0.001), (0.599, -0.001, 0.799))
GRIP_RIGHT = box((0.54, -0.06, 0.3), (0.56, -0.021, 0.5))
GRIP_TOP = box((0.1, -0.06, 0.7), (0.5, -0.021, 0.72))
DRAWER = [
    box((0.001, -0.02, 0.402), (0.599, -0.001, 0.799)),
    box((0.25, -0.06, 0.59), (0.35, -0.021, 0.61)),
    box((0.03, -0.001, 0.45), (0.04, 0.45, 0.7)),
    box((0.56, -0.001, 0.45), (0.57, 0.45, 0.7)),
    box((0.04, -0.001, 0.44), (0.56, 0.45, 0.45)),
    box((0.04, 0.44, 0.45), (0.56, 0.45, 0.7)),
]


def articulate(*meshes):
    return GeometricArticulator().articulate(concatenate(list(meshes)))


def only_joint(articulation):
    assert len(articulation.joints) == 1, articulation.notes
    return articulation.joints[0]


def test_a_door_hinges_across_from_its_handle_which_moves_with_it():
    articulation = articulate(*CARCASS, DOOR, GRIP_RIGHT)
    joint = only_joint(articulation)
    assert (joint.name, joint.kind) == ("door_0_hinge", JointKind.REVOLUTE)
    assert np.allclose(joint.axis, [0, 0, -1])
    assert joint.origin[0] == pytest.approx(0.001)
    assert joint.lower == 0.0
    assert joint.upper == pytest.approx(np.radians(90))
    assert [part.name for part in articulation.parts] == ["base", "door_0"]
    assert np.array_equal(articulation.parts[1].faces, np.arange(60, 84))


def test_a_wide_door_with_its_handle_at_the_top_opens_downwards():
    joint = only_joint(articulate(*CARCASS, DOOR, GRIP_TOP))
    assert np.allclose(joint.axis, [1, 0, 0])
    assert joint.origin[2] == pytest.approx(0.001)


def test_a_panel_with_a_box_behind_is_a_drawer_that_takes_its_box_along():
    lower_door = box((0.001, -0.02, 0.001), (0.599, -0.001, 0.4))
    grip = box((0.54, -0.06, 0.15), (0.56, -0.021, 0.3))
    articulation = articulate(*CARCASS, *DRAWER, lower_door, grip)
    drawer = articulation.joint("drawer_0_slide")
    assert drawer.kind is JointKind.PRISMATIC
    assert np.allclose(drawer.axis, [0, -1, 0])
    assert drawer.upper == pytest.approx(0.92 * 0.451, rel=0.02)
    assert np.array_equal(articulation.parts[drawer.child].faces, np.arange(60, 60 + 72))
    assert articulation.joint("door_0_hinge").kind is JointKind.REVOLUTE


def test_a_door_before_a_column_opens_only_as_far_as_it_can():
    column = box((0.05, -0.5, 0.0), (0.15, -0.4, 0.8))
    joint = only_joint(articulate(*CARCASS, DOOR, GRIP_RIGHT, column))
    assert np.radians(50) < joint.upper < np.radians(85)


def test_guesses_are_said():
    left = box((0.001, -0.02, 0.001), (0.299, -0.001, 0.799))
    right = box((0.301, -0.02, 0.001), (0.599, -0.001, 0.799))
    articulation = articulate(*CARCASS, left, right)
    assert len(articulation.joints) == 2
    assert any("door_0" in note and "assumed left" in note for note in articulation.notes)
    assert any("door_1" in note and "assumed right" in note for note in articulation.notes)


def test_a_fused_mesh_is_kept_rigid_and_says_so():
    articulation = GeometricArticulator().articulate(box((0, 0, 0), (1, 1, 1)))
    assert articulation.joints == ()
    (note,) = articulation.notes
    assert note == ("the mesh is one connected surface: nothing can be told apart; kept rigid")


TABLE = [
    box((0, 0, 0.7), (1.2, 0.8, 0.74)),
    *(box((x, y, 0), (x + 0.05, y + 0.05, 0.7)) for x in (0, 1.15) for y in (0, 0.75)),
    box((0.05, 0, 0.6), (1.15, 0.02, 0.7)),
    box((0.05, 0.78, 0.6), (1.15, 0.8, 0.7)),
]
CHAIR = [
    box((0, 0, 0.42), (0.45, 0.45, 0.46)),
    *(box((x, y, 0), (x + 0.04, y + 0.04, 0.42)) for x in (0, 0.41) for y in (0, 0.41)),
    box((0, 0.41, 0.46), (0.45, 0.45, 0.95)),
]
OPEN_SHELF = [*CARCASS, box((0.02, 0.02, 0.4), (0.58, 0.48, 0.42))]
RUG = [box((0, 0, 0), (2, 1.4, 0.01)), box((0.1, 0.1, 0.01), (1.9, 1.3, 0.012))]


@pytest.mark.parametrize(
    "meshes", [TABLE, CHAIR, OPEN_SHELF, RUG], ids=["table", "chair", "open shelf", "rug"]
)
def test_what_does_not_open_stays_rigid(meshes):
    articulation = articulate(*meshes)
    assert [part.name for part in articulation.parts] == ["base"]
    assert len(articulation.notes) == 1


@pytest.mark.parametrize("degrees", [90, 180, 270, 30])
def test_the_front_is_found_whichever_way_it_faces(degrees):
    mesh = concatenate([*CARCASS, DOOR, GRIP_RIGHT])
    turn = rotation_about([0, 0, 1], np.radians(degrees))
    at_rest = only_joint(GeometricArticulator().articulate(mesh))
    turned = only_joint(GeometricArticulator().articulate(mesh.turned(turn)))
    assert np.allclose(turned.axis, at_rest.axis)
    assert np.allclose(turned.origin[:2], (turn @ at_rest.origin)[:2], atol=1e-3)


@pytest.mark.parametrize(
    ("vertices", "faces"),
    [
        (np.zeros((0, 3)), np.zeros((0, 3))),
        (np.zeros((6, 3)), [[0, 1, 2], [3, 4, 5]]),
        (np.eye(3)[[0, 1, 2, 0, 1, 2]] + np.repeat([[0], [3]], 3, axis=0), [[0, 1, 2], [3, 4, 5]]),
        (np.random.default_rng(0).random((600, 3)), np.arange(600).reshape(-1, 3)),
    ],
    ids=["empty", "points", "flat", "soup"],
)
def test_any_mesh_gets_an_answer(vertices, faces):
    articulation = GeometricArticulator().articulate(Mesh.from_triangles(vertices, faces))
    assert articulation.joints == ()
    assert articulation.notes


@cache
def generated(category):
    truth = make_object(category, 1)
    return truth, GeometricArticulator().articulate(truth.mesh)


@pytest.mark.parametrize("category", ["cabinet", "fridge", "oven", "microwave", "dishwasher"])
def test_generated_furniture_opens_as_it_was_made(category):
    truth, found = generated(category)
    for joint in truth.movable_joints:
        faces = truth.parts[joint.child].faces
        if joint.name.startswith("pedal"):
            continue
        matches = [j for j in found.joints if _overlap(found.parts[j.child].faces, faces) > 0.5]
        assert len(matches) == 1, (joint.name, found.notes)
        assert (matches[0].kind is JointKind.PRISMATIC) == (joint.kind is JointKind.PRISMATIC)
        turn = 1.0 if joint.upper >= -joint.lower else -1.0
        assert matches[0].axis @ joint.axis * turn > 0.99
    # The generator's microwave ovens have plates that stay, real ones turn theirs.
    opening = [j for j in found.joints if not j.name.startswith("turntable")]
    assert len(opening) <= len(truth.movable_joints)


def _overlap(a, b):
    return len(np.intersect1d(a, b)) / max(len(np.union1d(a, b)), 1)
