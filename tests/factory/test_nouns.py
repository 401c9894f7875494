"""The nouns refuse what no simulator should be given, and move as rotations and slides do."""

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from asset_factory.factory.articulation import Articulation, Joint, JointKind, Part, rotation_about
from asset_factory.factory.asset import Asset, Hull, Inertial, PartBody
from asset_factory.factory.errors import InvalidArticulation, InvalidAsset
from asset_factory.factory.mesh import Mesh
from asset_factory.factory.part import OpensBy, Panel, PartKind


def triangles(count):
    vertices = np.arange(9 * count, dtype=float).reshape(-1, 3)
    return Mesh.from_triangles(vertices, np.arange(3 * count).reshape(-1, 3))


def hinge(**changes):
    settings = {"name": "hinge", "kind": JointKind.REVOLUTE, "parent": 0, "child": 1}
    settings |= {"axis": [0, 0, 1], "origin": [0, 0, 0], "lower": 0.0, "upper": 1.0}
    return Joint(**{**settings, **changes})


def two_parts(joint, parts=None):
    parts = parts or (Part("base", [0]), Part("door", [1]))
    return Articulation(triangles(2), parts, (joint,), "test")


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"axis": [0, 0, 0.5]}, "joint 'hinge': axis must have length 1, not 0.5"),
        ({"axis": [0, 0, np.nan]}, "axis must be three"),
        ({"origin": [0, np.inf, 0]}, "origin must be three"),
        ({"lower": 1.0, "upper": 0.0}, "want lower < upper"),
        ({"lower": 0.5, "upper": 1.0}, "leave out 0, the pose of the input mesh"),
        ({"upper": np.inf}, "want finite ones"),
        ({"kind": JointKind.FIXED}, r"is fixed with limits \[0.0, 1.0\]"),
        ({"parent": 1}, "parents first"),
        ({"child": 2}, "tree order"),
        ({"name": "a b"}, "want a name of letters"),
        ({"friction": -1.0}, "friction must be .* not -1.0"),
    ],
)
def test_a_wrong_joint_is_refused_with_its_number(changes, sentence):
    with pytest.raises(InvalidArticulation, match=sentence):
        two_parts(hinge(**changes))


@pytest.mark.parametrize(
    ("parts", "sentence"),
    [
        ((Part("base", [0]), Part("base", [1])), "appears twice"),
        ((Part("world", [0]), Part("door", [1])), "keeps that name for the ground"),
        ((Part("base", [0, 1]), Part("door", [1])), "shares 1 faces with 'base'"),
        ((Part("base", [0]), Part("door", [])), "1 faces of the mesh belong to no part"),
        ((Part("base", [0]), Part("door", [5])), "has a face outside 0..1"),
        ((Part("base", [0, 1]),), "1 joints for 1 parts"),
    ],
)
def test_wrong_parts_are_refused(parts, sentence):
    with pytest.raises(InvalidArticulation, match=sentence):
        two_parts(hinge(), parts)


def test_arrays_cannot_be_edited_in_place():
    articulation = two_parts(hinge())
    for array in (
        articulation.mesh.vertices,
        articulation.parts[0].faces,
        articulation.joints[0].axis,
    ):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1


def test_a_quarter_turn_about_a_displaced_axis_and_of_an_unknown_joint():
    turning = two_parts(hinge(origin=[1, 0, 0]))
    with pytest.raises(KeyError, match="hinge"):
        turning.poses({"door": 1.0})
    poses = turning.poses({"hinge": np.pi / 2})
    np.testing.assert_allclose(poses[1] @ [2, 0, 0, 1], [1, 1, 0, 1], atol=1e-12)
    np.testing.assert_array_equal(poses[0], np.eye(4))


finite = st.floats(-2, 2)
vectors = st.tuples(finite, finite, finite)


@given(vectors.filter(lambda v: np.linalg.norm(v) > 0.1), st.floats(-7, 7))
def test_rotations_agree_with_scipy(axis, angle):
    unit = np.array(axis) / np.linalg.norm(axis)
    wanted = Rotation.from_rotvec(unit * angle).as_matrix()
    np.testing.assert_allclose(rotation_about(unit, angle), wanted, atol=1e-12)


@st.composite
def trees(draw):
    count = draw(st.integers(2, 6))
    joints = []
    for child in range(1, count):
        axis = np.array(draw(vectors.filter(lambda v: np.linalg.norm(v) > 0.1)))
        kind = draw(st.sampled_from(list(JointKind)))
        moves = kind is not JointKind.FIXED
        parent = draw(st.integers(0, child - 1))
        line = (axis / np.linalg.norm(axis), draw(vectors))
        far = 1.0 if moves else 0.0
        joints.append(Joint(f"j{child}", kind, parent, child, *line, -far, far))
    parts = tuple(Part(f"p{i}", [i]) for i in range(count))
    return Articulation(triangles(count), parts, tuple(joints), "test")


@settings(max_examples=50)
@given(trees(), st.data())
def test_children_move_with_their_parents(tree, data):
    values = {joint.name: data.draw(st.floats(-1, 1)) for joint in tree.joints}
    poses = tree.poses(values)
    for joint in tree.joints:
        relative = np.linalg.inv(poses[joint.parent]) @ poses[joint.child]
        np.testing.assert_allclose(relative, joint.motion(values[joint.name]), atol=1e-9)
        if joint.turns:
            # Points on the axis stay where the parent has them.
            on_axis = np.append(joint.origin + 0.3 * joint.axis, 1.0)
            there = poses[joint.parent] @ on_axis
            np.testing.assert_allclose(poses[joint.child] @ on_axis, there, atol=1e-9)
    np.testing.assert_allclose(tree.poses(), np.tile(np.eye(4), (len(tree.parts), 1, 1)))


FRAME = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]])
DOOR = Part(
    "door_0",
    np.arange(3),
    0.7,
    kind=PartKind.DOOR,
    panel=Panel(FRAME, [0.1, 0.2], [0.5, 0.8], -0.3, 0.02, OpensBy.LEFT),
)


def test_a_panel_knows_where_it_is_and_turns_with_its_part_and_handle():
    panel = DOOR.panel
    np.testing.assert_allclose(panel.center, [0.3, -0.3, 0.5])
    np.testing.assert_allclose(panel.outward, [0.0, -1.0, 0.0])
    np.testing.assert_allclose(panel.size, [0.4, 0.6])
    turn = rotation_about([0.0, 0.0, 1.0], 0.3)
    turned = DOOR.turned(turn)
    np.testing.assert_allclose(turned.panel.center, turn @ panel.center)
    np.testing.assert_allclose(turned.panel.outward, turn @ panel.outward)
    np.testing.assert_allclose(turned.turned(turn.T).panel.frame, panel.frame, atol=1e-15)


BOX = trimesh.creation.box((1, 2, 3))


def test_a_box_has_its_volume_wherever_it_lies():
    assert Hull(BOX.vertices + 100.0, BOX.faces).volume == pytest.approx(6.0)


@pytest.mark.parametrize(
    ("vertices", "faces"),
    [
        (BOX.vertices[:3], [[0, 1, 2]]),
        (BOX.vertices * [1, 1, 0], BOX.faces),
        (BOX.vertices, BOX.faces[:, ::-1]),
        (BOX.vertices * np.nan, BOX.faces),
    ],
)
def test_flat_inverted_or_broken_hulls_are_refused(vertices, faces):
    with pytest.raises(InvalidAsset, match="hull"):
        Hull(vertices, faces)


@pytest.mark.parametrize(
    ("mass", "moments", "sentence"),
    [
        (0.0, (1, 1, 1), "mass must be more than 0, not 0.0 kg"),
        (np.nan, (1, 1, 1), "mass must be more than 0, not nan kg"),
        (1.0, (1, 1, -1), "smallest principal moment is -1"),
        (1.0, (1, 1, 3), "triangle inequality"),
        (1.0, (1, 1, np.inf), "not finite"),
    ],
)
def test_impossible_inertias_are_refused(mass, moments, sentence):
    with pytest.raises(InvalidAsset, match=sentence):
        Inertial(mass, np.zeros(3), np.diag(np.array(moments, dtype=float)))


def test_a_part_with_faces_needs_a_hull():
    mesh = Mesh.from_triangles(BOX.vertices, BOX.faces)
    articulation = Articulation(mesh, (Part("base", np.arange(12)),), (), "test")
    inertial = Inertial(1.0, np.zeros(3), np.eye(3))
    with pytest.raises(InvalidAsset, match="no hull to collide with"):
        Asset("box", articulation, (PartBody((), inertial),))
    asset = Asset("box", articulation, (PartBody((Hull(BOX.vertices, BOX.faces),), inertial),))
    assert asset.hull_count == 1
