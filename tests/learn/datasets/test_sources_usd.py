"""USD: joints, bodies and units as the physics schema means them."""

import numpy as np
import pytest

pytest.importorskip("pxr")
from refusing import refusal
from usda import BASE, CABINET, DOOR, HINGE, body, joint, mesh, stage, write

from asset_factory.factory.geometry.posing import posed
from asset_factory.factory.intake.importers import usd
from asset_factory.learn.datasets.description import find_usd, read_description
from asset_factory.learn.datasets.settings import SourceSettings


@pytest.fixture(autouse=True)
def read_here(monkeypatch):
    """Spare every read a child process, which other tests prove."""
    monkeypatch.setattr(usd, "ask_of", lambda _child, _name, ask, *given: ask(*given))


def read(folder, text):
    write(folder / "thing", text)
    (item,) = find_usd(folder)
    return read_description(item, SourceSettings())


def test_door_opens_to_the_front_with_positive_values(tmp_path):
    cabinet = read(tmp_path, stage(CABINET))
    assert [part.name for part in cabinet.parts] == ["base", "door"]
    assert [len(part.faces) for part in cabinet.parts] == [12, 12]
    (hinge,) = cabinet.joints
    np.testing.assert_allclose([hinge.lower, hinge.upper], [0.0, np.pi / 2.0], atol=1e-6)
    opened = posed(cabinet, {hinge.name: hinge.upper})
    np.testing.assert_allclose(opened.part_mesh(1).bounds[0], [-0.51, -1.31, -0.4], atol=1e-6)


def test_lengths_on_a_scaled_body_are_scaled(tmp_path):
    base = body("base", (0, 0, 0), mesh("box", (0.5, 0.3, 0.4)), scale=2.0)
    hinge = HINGE.replace("(-0.5, -0.31, 0)", "(-0.25, -0.155, 0)")
    held = joint("hinge", "Revolute", "/obj/base", "/obj/door", hinge)
    scaled = read(tmp_path, stage(base + DOOR + held))
    np.testing.assert_allclose(scaled.joints[0].origin[:2], [-0.5, -0.31], atol=1e-6)


def test_joint_named_from_the_door_to_the_base_is_the_same_joint(tmp_path):
    limits = (
        'uniform token physics:axis = "Z"\npoint3f physics:localPos0 = (-0.5, 0, 0)\n'
        "float physics:lowerLimit = 0\nfloat physics:upperLimit = 90\n"
    )
    held = joint("held", "Fixed", "", "/obj/base")
    text = stage(BASE + DOOR + held + joint("hinge", "Revolute", "/obj/door", "/obj/base", limits))
    cabinet = read(tmp_path, text)
    assert [part.name for part in cabinet.parts] == ["base", "door"]
    np.testing.assert_allclose(cabinet.joints[0].axis, [0.0, 0.0, -1.0], atol=1e-6)


@pytest.mark.parametrize(
    ("value", "second"), [(-0.2, "(0, 0, -0.2)"), (0.1, "(0, 0, 0.1)"), (0.0, "(0, 0.3, 0)")]
)
def test_value_at_the_authored_pose_is_taken_off_the_limits(tmp_path, value, second):
    inside = (
        'uniform token physics:axis = "Z"\npoint3f physics:localPos0 = (0, -0.31, 0)\n'
        f"point3f physics:localPos1 = {second}\n"
        "quatf physics:localRot1 = (1, 0, 0, 0)\nfloat physics:lowerLimit = -0.2\n"
        "float physics:upperLimit = 0.3\n"
    )
    held = joint("slide", "Prismatic", "/obj/base", "/obj/door", inside)
    slide = read(tmp_path, stage(BASE + DOOR + held)).joints[0]
    ends = sorted(abs(value) for value in (slide.lower, slide.upper))
    np.testing.assert_allclose(ends, sorted((abs(-0.2 - value), abs(0.3 - value))), atol=1e-6)


def test_turned_joint_frames_shift_a_hinge(tmp_path):
    half = np.radians(15.0)
    inside = HINGE.replace("-90", "-60") + (
        "point3f physics:localPos1 = (-0.5, 0, 0)\n"
        f"quatf physics:localRot1 = ({np.cos(half):.8f}, 0, 0, {-np.sin(half):.8f})\n"
    )
    held = joint("hinge", "Revolute", "/obj/base", "/obj/door", inside)
    hinge = read(tmp_path, stage(BASE + DOOR + held)).joints[0]
    ends = sorted(abs(value) for value in (hinge.lower, hinge.upper))
    np.testing.assert_allclose(ends, np.radians([30.0, 30.0]), atol=1e-5)


def test_hinge_without_limits_is_continuous_and_a_slide_goes_as_far_as_usual(tmp_path):
    free = joint("hinge", "Revolute", "/obj/base", "/obj/door")
    assert read(tmp_path / "a", stage(BASE + DOOR + free)).joints[0].kind == "continuous"
    endless = joint("slide", "Prismatic", "/obj/base", "/obj/door")
    assert read(tmp_path / "b", stage(BASE + DOOR + endless)).joints[0].upper > 0.0


def test_fixed_bodies_are_one_part_and_loose_ones_stand_still(tmp_path):
    handle = body("handle", (0.4, -0.34, 0), mesh("grip", (0.02, 0.04, 0.2)))
    foot = body("foot", (0, 0, -0.45), mesh("block", (0.2, 0.2, 0.1)))
    fixed = joint("screw", "Fixed", "/obj/door", "/obj/handle")
    cabinet = read(tmp_path, stage(CABINET + handle + foot + fixed))
    assert [len(part.faces) for part in cabinet.parts] == [24, 24]


def test_bodies_in_bodies_and_surfaces_that_are_no_body(tmp_path):
    inner = body("door", (0, -0.31, 0), mesh("panel", (1.0, 0.02, 0.8)))
    outer = body("base", (0, 0, 0), mesh("box", (1.0, 0.6, 0.8)) + inner)
    hinge = joint("hinge", "Revolute", "/obj/base", "/obj/base/door", HINGE)
    nested = read(tmp_path / "a", stage(outer + hinge))
    assert [len(part.faces) for part in nested.parts] == [12, 12]
    shelf = mesh("shelf", (1.0, 0.6, 0.02))
    held = joint("hinge", "Revolute", "", "/obj/door", HINGE)
    static = read(tmp_path / "b", stage(shelf + DOOR + held))
    assert [part.name for part in static.parts] == ["base", "door"]


def test_colliders_guides_and_hidden_surfaces_are_not_seen(tmp_path):
    extra = (
        mesh("guide", (2, 2, 2), 'uniform token purpose = "guide"')
        + mesh("hidden", (2, 2, 2), 'token visibility = "invisible"')
        + 'def Xform "collisions"\n{\n'
        + mesh("hull", (2, 2, 2))
        + "}\n"
    )
    base = body("base", (0, 0, 0), mesh("box", (1.0, 0.6, 0.8)) + extra)
    hinge = joint("hinge", "Revolute", "/obj/base", "/obj/door", HINGE)
    parts = read(tmp_path, stage(base + DOOR + hinge)).parts
    assert [len(part.faces) for part in parts] == [12, 12]


def test_instances_and_primitives(tmp_path):
    shape = '\nclass Xform "_shape"\n{\n' + mesh("panel", (1.0, 0.02, 0.8)) + "}\n"
    made = 'def Xform "made" (instanceable = true\n references = </_shape>)\n{\n}\n'
    door = body("door", (0, -0.31, 0), made)
    base = body("base", (0, 0, 0), 'def Cube "box"\n{\ndouble size = 0.6\n}\n')
    hinge = joint("hinge", "Revolute", "/obj/base", "/obj/door", HINGE)
    read_back = read(tmp_path, stage(base + door + hinge) + shape)
    assert [len(part.faces) for part in read_back.parts] == [12, 12]


LOOP = joint("again", "Revolute", "/obj/base", "/obj/door", HINGE)


def test_joint_outside_the_articulation_is_none(tmp_path):
    outside = "bool physics:excludeFromArticulation = true\nrel physics:body1"
    text = stage(CABINET + LOOP.replace("rel physics:body1", outside))
    assert len(read(tmp_path, text).joints) == 1


@pytest.mark.parametrize(
    ("text", "code"),
    [
        (CABINET + LOOP, "not_a_tree"),
        (BASE + DOOR + joint("ball", "Spherical", "/obj/base", "/obj/door"), "unsupported_joint"),
        (CABINET.replace("[4, 4, 4, 4, 4, 4]", "[4, 4, 4, 4, 4, 9]"), "unreadable"),
        (CABINET.replace("[0, 1, 3, 2", "[0, 1, 99, 2"), "unreadable"),
        (BASE + DOOR, "no_movable_joint"),
        ("", "empty"),
    ],
    ids=["loop", "ball", "counts", "corners", "still", "empty"],
)
def test_what_nothing_can_be_learned_from_is_refused(tmp_path, text, code):
    assert refusal(read, tmp_path, stage(text)).code == code
