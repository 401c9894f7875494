"""Assemblies: chains move along, carriers turn and slide, rest poses stay in reach."""

import numpy as np
import pytest

from asset_factory.factory.articulation import JointKind
from asset_factory.factory.geometry.posing import posed
from asset_factory.learn.objects.kit import axes
from asset_factory.learn.objects.kit.assembly import Assembly
from asset_factory.learn.objects.kit.axes import LEFT, RIGHT, UP
from asset_factory.learn.objects.kit.looks import BLACK, STEEL, wood
from asset_factory.learn.objects.kit.shapes import box

SPAN_X = (3.0, 4.0)
SPAN_Y = (0.0, 1.0)


def begun(hairline=0.0):
    a = Assembly(np.random.default_rng(0), hairline)
    a.body(STEEL).add(box(SPAN_X, SPAN_Y, (5.0, 6.0)))
    return a


def test_the_object_is_put_on_the_ground_over_the_origin_with_its_joints():
    a = begun()
    a.hinge("arm", UP, (3.0, 0.0, 6.0), 1.0, look=BLACK).add(box(SPAN_X, SPAN_Y, (6.1, 7.0)))
    made = a.articulation()
    np.testing.assert_allclose(made.mesh.bounds, [[-0.5, -0.5, 0.0], [0.5, 0.5, 2.0]], atol=1e-12)
    assert made.mesh.bounds[0, 2] == 0.0
    np.testing.assert_allclose(made.joint("arm_joint").origin, [-0.5, -0.5, 1.0])
    assert {material.name for material in made.mesh.materials} == {"steel", "black"}


def test_what_hangs_on_a_part_moves_with_it():
    a = begun()
    arm = a.hinge("arm", UP, (3.0, 0.0, 6.0), 1.0)
    arm.add(box(SPAN_X, SPAN_Y, (6.1, 7.0)))
    a.slider("hand", RIGHT, (3.0, 0.0, 7.0), 0.5, on=arm).add(box(SPAN_X, SPAN_Y, (7.1, 8.0)))
    made = a.articulation()
    assert [(j.parent, j.child) for j in made.joints] == [(0, 1), (1, 2)]
    poses = made.poses({"arm_joint": np.pi / 2, "hand_joint": 0.25})
    # The hand's own slide, along +X, has turned into +Y.
    np.testing.assert_allclose(poses[2][:3, 3] - poses[1][:3, 3], [0.0, 0.25, 0.0], atol=1e-12)


def test_a_part_that_turns_and_slides_hangs_on_a_carrier_without_faces():
    a = begun()
    cap = a.spin("cap", UP, (3.5, 0.5, 6.0), 0.2)
    cap.add(box(SPAN_X, SPAN_Y, (6.1, 7.0)))
    a.hinge("tab", RIGHT, (3, 0, 7), 1.0, on=cap).add(box(SPAN_X, SPAN_Y, (7.1, 8.0)))
    made = a.articulation()
    assert [p.name for p in made.parts] == ["body", "cap_carrier", "cap", "tab"]
    assert len(made.parts[1].faces) == 0
    turn, slide, tab = made.joints
    assert (turn.kind, slide.kind) == (JointKind.CONTINUOUS, JointKind.PRISMATIC)
    assert (turn.lower, turn.upper) == (-np.pi, np.pi)
    assert (slide.lower, slide.upper) == (0.0, 0.2)
    assert tab.parent == 2
    assert sum(len(p.faces) for p in made.parts) == len(made.mesh.faces)


def chain(rest):
    """A lid that turns to the left, and a tongue at its far end."""
    a = begun()
    lid = a.hinge("lid", LEFT, (3.5, 1.0, 6.0), 2.0, rest=rest)
    lid.add(box(SPAN_X, SPAN_Y, (6.0, 6.1)))
    a.hinge("tongue", LEFT, (3.5, 0.0, 6.0), 1.0, on=lid).add(box(SPAN_X, (-0.3, 0.0), (6.0, 6.1)))
    return a.articulation()


def test_an_object_left_open_closes_to_what_was_described():
    shut = chain(0.0)
    ajar = chain(1.2)
    lid = ajar.joint("lid_joint")
    assert (lid.lower, lid.upper) == pytest.approx((-1.2, 0.8))
    offset = shut.joint("lid_joint").origin - lid.origin
    for value in (0.0, 0.7):
        there = posed(shut, {"tongue_joint": value}).mesh.vertices
        here = posed(ajar, {"lid_joint": lid.lower, "tongue_joint": value}).mesh.vertices
        np.testing.assert_allclose(here + offset, there, atol=1e-9)


@pytest.mark.parametrize(
    ("place", "outwards", "level"),
    [
        (axes.facing_front(0.4), (0.0, -1.0, 0.0), -0.4),
        (axes.facing_up(0.4), (0.0, 0.0, 1.0), 0.4),
        (axes.facing_side(0.4), (1.0, 0.0, 0.0), 0.4),
        (axes.facing_side(-0.4), (-1.0, 0.0, 0.0), 0.4),
    ],
)
def test_a_face_is_described_as_if_it_looked_to_the_front(place, outwards, level):
    np.testing.assert_array_equal(place[:3, :3] @ (0.0, -1.0, 0.0), outwards)
    np.testing.assert_allclose(place[:3, :3] @ place[:3, :3].T, np.eye(3))
    form = box((0.1, 0.2), (-0.3, 0.0), (0.5, 0.6)).moved(place)
    reach = form.vertices @ np.array(outwards)
    assert (reach.min(), reach.max()) == pytest.approx((level, level + 0.3))
    a, b, c = form.vertices[form.faces].transpose(1, 0, 2)
    assert np.einsum("ij,ij->", np.cross(a, b), c) / 6.0 == pytest.approx(0.1 * 0.3 * 0.1)


def test_with_a_hairline_no_two_forms_share_a_corner():
    for hairline, shared in ((0.0, True), (1e-4, False)):
        a = begun(hairline)
        a.root.add(box(SPAN_X, SPAN_Y, (6.0, 7.0)))
        vertices = a.articulation().mesh.vertices
        assert (len(np.unique(np.round(vertices, 6), axis=0)) < len(vertices)) is shared


def test_only_textured_faces_have_texture_coordinates_and_those_are_to_scale():
    a = begun()
    a.root.add(box((0.0, 0.5), (0.0, 0.1), (0.0, 1.0)), look=wood(3, size=8))
    mesh = a.articulation().mesh
    grain = np.array([m.texture is not None for m in mesh.materials])[mesh.face_material]
    assert np.isnan(mesh.corner_uv[~grain]).all()
    # The grain's period is half a metre: the board is one or two of them long.
    assert np.ptp(mesh.corner_uv[grain][..., 0]) == pytest.approx(2.0, rel=1e-9)
