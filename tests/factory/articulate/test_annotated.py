"""Annotation -> Articulation: what normalisation changes, and that it says so."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from plain_solids import box_between as box
from refusing import refusal

from asset_factory.factory.articulate.annotated import AnnotatedArticulator
from asset_factory.factory.articulation import JointKind, rotation_about
from asset_factory.factory.intake.annotation import AnnotatedJoint, Annotation
from asset_factory.factory.mesh import concatenate

BODY = box((0, 0, 0), (1, 1, 1))
FRONT = box((0, -0.1, 0), (1, 0, 1))
HANDLE = box((0.4, -0.2, 0.4), (0.6, -0.1, 0.6))


def joint(kind, lower=0.0, upper=1.0, **changes):
    values = {
        "name": "j",
        "kind": kind,
        "parent": 0,
        "child": 1,
        "axis": np.array([0.0, -1.0, 0.0]) if kind == "prismatic" else np.array([0.0, 0.0, -1.0]),
        "origin": np.zeros(3),
        "lower": lower,
        "upper": upper,
    }
    return AnnotatedJoint(**(values | changes))


def build(meshes, joints, names=None, transform=None, lenient=False):
    present = [mesh for mesh in meshes if mesh is not None]
    labels = np.concatenate([np.full(len(m.faces), i) for i, m in enumerate(meshes) if m])
    matrix = np.eye(4) if transform is None else transform
    annotation = Annotation(
        labels, tuple(names or [f"p{i}" for i in range(len(meshes))]), tuple(joints), "urdf"
    )
    mesh = concatenate(present).transformed(matrix)
    faces = np.arange(len(labels))
    return AnnotatedArticulator(annotation, matrix, faces, lenient=lenient).articulate(mesh)


def cabinet(*joints):
    return build([BODY, FRONT], list(joints))


def said(articulation, words):
    return any(words in note for note in articulation.notes)


def code_of(*joints):
    found = refusal(cabinet, *joints)
    assert "'j'" in found.message
    return found.code


def test_a_plain_drawer_passes_through_without_a_note():
    result = cabinet(joint("prismatic", 0.0, 0.4, damping=3.0))
    drawer = result.joints[0]
    assert (drawer.lower, drawer.upper, drawer.damping) == (0.0, 0.4, 3.0)
    assert result.notes == ()
    assert result.articulator == "annotated"


Y = np.array([0.0, 1.0, 0.0])
Z = np.array([0.0, 0.0, 1.0])
HALF_OPEN = box((0, -0.4, 0), (1, -0.3, 1))
WIDE_OPEN = box((0, -1.1, 0), (1, -1.0, 1))
KNOB = box((0.4, -0.1, 0.4), (0.6, 0.0, 0.6))


@pytest.mark.parametrize(
    ("part", "given", "limits", "axis", "says"),
    [
        (FRONT, joint("revolute", -1.5, 0.0, axis=Z), (0.0, 1.5), -Z, "reversed"),
        (HALF_OPEN, joint("prismatic", -0.3, 0.2), (-0.3, 0.2), -Y, "inside its range"),
        (HALF_OPEN, joint("prismatic", -0.2, 0.3, axis=Y), (-0.3, 0.2), -Y, "inside its range"),
        (WIDE_OPEN, joint("prismatic", -1.0, 0.0), (-1.0, 0.0), -Y, "taken as open"),
        (
            KNOB,
            joint("revolute", -2.0, 2.0, axis=Y, origin=[0.5, 0.0, 0.5]),
            (-2.0, 2.0),
            Y,
            "neither end is clearly closed",
        ),
    ],
    ids=["opens downwards", "half open", "half open, backwards", "open", "a knob, of no end"],
)
def test_a_joint_is_turned_round_where_the_object_is_smaller_at_its_upper_limit(
    part, given, limits, axis, says
):
    result = build([BODY, part], [given])
    (found,) = result.joints
    assert (found.lower, found.upper) == pytest.approx(limits)
    np.testing.assert_allclose(found.axis, axis)
    assert said(result, says)


def test_an_input_outside_the_range_is_posed_at_the_nearest_limit():
    second = joint("prismatic", 0.0, 0.1, name="k", parent=1, child=2, origin=[0.5, -0.2, 0.5])
    result = build([BODY, FRONT, HANDLE], [joint("prismatic", 0.25, 0.5), second])
    assert (result.joint("j").lower, result.joint("j").upper) == pytest.approx((0.0, 0.25))
    np.testing.assert_allclose(result.part_mesh(0).bounds, BODY.bounds)
    np.testing.assert_allclose(result.part_mesh(1).bounds, FRONT.bounds - [0.0, 0.25, 0.0])
    np.testing.assert_allclose(result.part_mesh(2).bounds, HANDLE.bounds - [0.0, 0.25, 0.0])
    assert said(result, "which is the new zero")


def test_posing_turns_the_axes_of_what_is_carried():
    leaf = box((1, -0.1, 0), (2, 0, 1))
    first = joint("revolute", np.pi / 2.0, 3.0, axis=np.array([0.0, 0.0, 1.0]))
    second = joint("prismatic", 0.0, 0.5, name="k", parent=1, child=2, axis=[1, 0, 0])
    result = build([BODY, FRONT, leaf], [first, second])
    np.testing.assert_allclose(result.joint("k").axis, [0.0, 1.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(result.part_mesh(2).bounds, [[0, 1, 0], [0.1, 2, 1]], atol=1e-12)


@pytest.mark.parametrize(
    ("lower", "upper", "kind", "says"),
    [
        (None, None, JointKind.CONTINUOUS, "has no limits"),
        (0.0, np.inf, JointKind.CONTINUOUS, "has no limits"),
        (np.nan, 1.0, JointKind.CONTINUOUS, "has no limits"),
        (0.0, 100.0, JointKind.CONTINUOUS, "over a full turn"),
        (-4.0, 4.0, JointKind.REVOLUTE, "over a full turn"),
        (0.0, 2.0 * np.pi, JointKind.REVOLUTE, "PhysX counts a full turn"),
        (1.0, 0.0, JointKind.REVOLUTE, "swapped"),
        (-1.0, 1.0, JointKind.REVOLUTE, "inside"),
    ],
)
def test_odd_limits_of_hinges_are_mended_with_a_note(lower, upper, kind, says):
    result = cabinet(joint("revolute", lower, upper))
    assert result.joints[0].kind is kind
    assert said(result, says)


@pytest.mark.parametrize("where", [0.0, 0.5])
def test_a_joint_without_range_is_fixed_where_it_stands(where):
    result = cabinet(joint("prismatic", where, where))
    assert len(result.parts) == 1
    assert result.mesh.bounds[0, 1] == pytest.approx(-0.1 - where)
    assert said(result, "taken as fixed")
    assert said(result, "nothing in this object moves")


def test_a_description_s_slide_without_limits_gets_usual_ones_and_says_so():
    scaled = np.diag([2.0, 2.0, 2.0, 1.0])
    result = build([BODY, FRONT], [joint("prismatic", None, None)], None, scaled, lenient=True)
    # The front is 0.2 m deep at this scale.
    assert (result.joints[0].lower, result.joints[0].upper) == pytest.approx((0.0, 0.1))
    assert said(result, "has no limits: taken to slide by 0.1 m")


def test_what_cannot_be_mended_is_refused_by_name():
    assert code_of(joint("prismatic", None, None)) == "no_limits"
    assert code_of(joint("prismatic", 0.0, np.inf)) == "no_limits"
    assert code_of(joint("revolute", axis=np.zeros(3))) == "bad_axis"
    assert code_of(joint("revolute", axis=np.array([np.nan, 0.0, 1.0]))) == "bad_axis"
    assert code_of(joint("screw")) == "unsupported_joint"
    assert code_of(joint("both")) == "bad_axis"


def test_a_description_with_two_roots_or_a_cycle_is_not_a_tree():
    for joints in ([], [joint("fixed"), joint("fixed", name="k", parent=1, child=0)]):
        assert refusal(cabinet, *joints).code == "not_a_tree"


def test_fixed_parts_merge_and_take_the_name_of_the_first_that_can_be_seen():
    fixed = joint("fixed", parent=0, child=1, name="f")
    slide = joint("prismatic", name="s", parent=1, child=2)
    plate = joint("fixed", name="g", parent=2, child=3)
    names = ["root", "case", "front", "handle"]
    result = build([None, BODY, FRONT, HANDLE], [plate, slide, fixed], names)
    assert [(part.name, len(part.faces)) for part in result.parts] == [("case", 12), ("front", 24)]
    assert said(result, "fixed to 'front' and made one part with it: 'handle'")


def test_empty_carriers_stay_and_empty_leaves_go():
    turn = joint("revolute", name="turn", parent=0, child=1)
    slide = joint("prismatic", name="slide", parent=1, child=2)
    leaf = joint("revolute", name="leaf", parent=2, child=3)
    twig = joint("revolute", name="twig", parent=3, child=4)
    result = build([BODY, None, FRONT, None, None], [turn, slide, leaf, twig])
    assert [len(part.faces) for part in result.parts] == [12, 0, 12]
    assert [j.name for j in result.joints] == ["turn", "slide"]
    assert said(result, "'p3' has no geometry and carries none")


def test_an_empty_root_that_carries_movers_stays():
    result = build([None, BODY, FRONT], [joint("prismatic"), joint("prismatic", name="k", child=2)])
    assert [len(part.faces) for part in result.parts] == [0, 12, 12]


def test_names_are_made_safe_and_unique():
    names = ["körper", "door#1", "door 1"]
    joints = [joint("prismatic", name="open me"), joint("prismatic", name="open_me", child=2)]
    result = build([BODY, FRONT, box((0, 0, 1), (1, 1, 2))], joints, names)
    assert [part.name for part in result.parts] == ["k_rper", "door_1", "door_1_2"]
    assert [j.name for j in result.joints] == ["open_me", "open_me_2"]
    assert said(result, "'door#1' is 'door_1'")


def test_negative_or_infinite_damping_is_ignored_with_a_note():
    result = cabinet(joint("prismatic", damping=-1.0, friction=np.inf))
    assert (result.joints[0].damping, result.joints[0].friction) == (None, None)
    assert said(result, "damping of -1.0 is ignored")
    assert said(result, "friction of inf is ignored")


def test_a_hinge_frame_lies_on_its_axis_beside_what_it_holds():
    result = cabinet(joint("revolute", origin=np.array([0.0, 0.0, 1000.0])))
    np.testing.assert_allclose(result.joints[0].origin, [0.0, 0.0, 0.5], atol=1e-9)


triples = st.tuples(*[st.floats(-3.0, 3.0)] * 3)


@settings(max_examples=30, deadline=None)
@given(triples, st.floats(0.1, 20.0), triples, st.floats(0.0, 1.0))
def test_scaling_and_turning_the_object_commutes_with_moving_it(angles, scale, shift, share):
    x, y, z = (rotation_about(axis, angle) for axis, angle in zip(np.eye(3), angles, strict=True))
    transform = np.eye(4)
    transform[:3, :3] = scale * x @ y @ z
    transform[:3, 3] = shift
    joints = [joint("revolute"), joint("prismatic", name="k", parent=1, child=2)]
    meshes = [BODY, FRONT, HANDLE]
    plain = build(meshes, joints)
    moved = build(meshes, joints, transform=transform)
    values = {"j": share, "k": share}
    there = {"j": share, "k": share * scale}
    for part in range(3):
        expected = transform @ plain.poses(values)[part]
        found = moved.poses(there)[part] @ transform
        np.testing.assert_allclose(found, expected, atol=1e-9 * max(1.0, scale))


def test_a_transform_that_bends_is_refused():
    with pytest.raises(ValueError, match="uniform"):
        build([BODY], [], transform=np.diag([1.0, 2.0, 1.0, 1.0]))
