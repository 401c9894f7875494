"""Stated parts are found on the mesh: boxes go to the seams they mean, joints to their edges."""

from contextlib import suppress

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from manifold3d import Manifold
from one_piece import doors, drawers, fridge, mesh_of

from asset_factory.factory.articulate.seams.articulator import SeamsArticulator
from asset_factory.factory.articulate.stated import StatedArticulator
from asset_factory.factory.articulation import JointKind, rotation_about
from asset_factory.factory.errors import InputRejected
from asset_factory.factory.intake.stated import stated_from

#: A pixel of a side's picture, and a groove's half [m].
FINE = 0.02


def articulated(mesh, *parts, **stated):
    made = StatedArticulator(stated_from({"parts": list(parts), **stated})).hypotheses(mesh)
    return tuple(each.articulation for each in made)


def box_of(articulation, part):
    """Lower and upper corner of a part [m], shape [2, 3]."""
    return articulation.part_mesh(part).bounds


@pytest.mark.parametrize("off", [-0.04, 0.0, 0.04])
def test_a_box_drawn_off_goes_to_the_seam_it_means(off):
    box = [0.05, 0.378 + off, 0.95, 0.667 + off]
    (made, *_) = articulated(drawers(), {"kind": "drawer", "side": "front", "box": box})
    low, high = box_of(made, 1)
    # The rails between drawers are 20 mm high; which of their edges is meant is anybody's guess.
    assert low[2] == pytest.approx(0.33, abs=FINE)
    assert high[2] == pytest.approx(0.61, abs=FINE)
    assert made.joints[0].kind is JointKind.PRISMATIC
    assert made.joints[0].axis == pytest.approx([0.0, -1.0, 0.0], abs=1e-9)


def test_a_door_is_hinged_where_it_is_said():
    part = {"kind": "door", "side": "front", "box": [0, 0.68, 1, 1]}
    for hinge, x, sign in (("left", 0.0, -1.0), ("right", 0.6, 1.0)):
        (made, *_) = articulated(fridge(), {**part, "hinge": hinge})
        assert made.joints[0].origin[0] == pytest.approx(x, abs=FINE)
        assert made.joints[0].axis == pytest.approx([0.0, 0.0, sign], abs=1e-9)
        assert box_of(made, 1)[0][2] == pytest.approx(1.1, abs=FINE)


def test_without_a_hinge_both_are_tried_the_handles_other_side_first():
    first, second = articulated(fridge(), {"kind": "door", "side": "front", "box": [0, 0.68, 1, 1]})
    assert first.joints[0].origin[0] == pytest.approx(0.6, abs=FINE)
    assert second.joints[0].origin[0] == pytest.approx(0.0, abs=FINE)


def test_two_doors_get_their_own_faces():
    left = {"kind": "door", "side": "front", "box": [0.03, 0.03, 0.5, 0.97], "hinge": "left"}
    right = {"kind": "door", "side": "front", "box": [0.5, 0.03, 0.97, 0.97], "hinge": "right"}
    (made,) = articulated(doors(), left, right)
    faces = [set(part.faces.tolist()) for part in made.parts]
    assert len(faces) == 3
    assert set.union(*faces) == set(range(len(made.mesh.faces)))
    assert sum(map(len, faces)) == len(made.mesh.faces)


def test_a_lid_is_what_is_above_its_box_hinged_across():
    (made, *_) = articulated(fridge(), {"kind": "lid", "side": "front", "box": [0, 0.69, 1, 1]})
    low, _ = box_of(made, 1)
    assert low[2] == pytest.approx(1.1, abs=FINE)
    assert abs(made.joints[0].axis[0]) == pytest.approx(1.0)
    assert made.joints[0].origin[1] > 0.5


def test_stated_limits_are_degrees_and_millimetres():
    door = {"kind": "door", "side": "front", "box": [0, 0.68, 1, 1], "hinge": "left"}
    drawer = {"kind": "drawer", "side": "front", "box": [0.05, 0.38, 0.95, 0.67]}
    (turned, *_) = articulated(fridge(), {**door, "range": [0, 90]})
    assert turned.joints[0].upper == pytest.approx(np.pi / 2.0)
    (slid, *_) = articulated(drawers(), {**drawer, "range": [0, 250]})
    assert slid.joints[0].upper == pytest.approx(0.25)


def test_the_front_may_look_anywhere():
    door = {"kind": "door", "side": "front", "box": [0, 0.68, 1, 1], "hinge": "left"}
    straight = articulated(fridge(), door)[0].joints[0]
    for front, quarters in (("x", 1), ("y", 2), ("-x", 3)):
        turn = np.round(rotation_about([0.0, 0.0, 1.0], quarters * np.pi / 2.0), 12)
        pose = np.eye(4)
        pose[:3, :3] = turn
        made = articulated(fridge().transformed(pose), door, front=front)[0].joints[0]
        assert made.origin == pytest.approx(turn @ straight.origin, abs=FINE)
        assert made.axis == pytest.approx(turn @ straight.axis, abs=1e-9)


def test_a_box_beside_the_mesh_says_what_it_shows():
    part = {"kind": "door", "side": "left", "box": [0.0, 0.0, 1.0, 1.0]}
    articulated(fridge(), part)
    with pytest.raises(InputRejected) as caught:
        articulated(
            fridge(),
            {"kind": "door", "side": "front", "box": [0.0, 0.68, 1.0, 1.0]},
            {"kind": "drawer", "side": "front", "box": [0.0, 0.6, 1.0, 1.0]},
        )
    assert caught.value.code == "stated_part_not_found"
    assert "parts[0] (door) and parts[1] (drawer): share" in str(caught.value)


def test_a_hinge_that_a_kind_cannot_have_is_refused():
    with pytest.raises(InputRejected, match=r"parts\[0\] \(door\): is hinged at its back"):
        articulated(
            fridge(), {"kind": "door", "side": "front", "box": [0, 0.68, 1, 1], "hinge": "back"}
        )


def test_nothing_opens_where_that_is_said():
    (made,) = articulated(fridge(), opens=False)
    assert made.movable_joints == ()


@settings(max_examples=10, deadline=None)
@given(st.tuples(*[st.floats(0.0, 1.0)] * 4))
def test_any_box_is_an_articulation_or_a_sentence(corners):
    x0, x1 = sorted(corners[:2])
    y0, y1 = sorted(corners[2:])
    if x0 == x1 or y0 == y1:
        return
    part = {"kind": "door", "side": "right", "box": [x0, y0, x1, y1]}
    with suppress(InputRejected):
        made = articulated(doors(), part)[0]
        assert len(made.parts) == 2
        assert len(made.parts[0].faces) + len(made.parts[1].faces) == len(made.mesh.faces)


def test_a_part_has_the_name_and_carries_what_was_stated():
    door = {"kind": "door", "side": "front", "box": [0, 0.68, 1, 1], "name": "freezer"}
    knob = {"kind": "knob", "side": "front", "box": [0.05, 0.7, 0.15, 0.9], "parent": "freezer"}
    made = articulated(fridge(), {**door, "hinge": "right"}, {**knob, "name": "grip"})[0]
    assert [part.name for part in made.parts] == ["base", "freezer", "grip"]
    assert [joint.name for joint in made.joints] == ["freezer_hinge", "grip_turn"]
    assert made.joints[1].parent == 1
    assert {part.source.proposer for part in made.parts[1:]} == {"sidecar"}


def test_a_sidecar_of_another_mesh_is_refused():
    with pytest.raises(InputRejected, match=r"sides are 1\.00 : 1\.00 : 1\.00, this one's are"):
        articulated(fridge(), size=[2, 2, 2])
    articulated(
        fridge(), {"kind": "door", "side": "front", "box": [0, 0.68, 1, 1]}, size=[6, 6, 16]
    )


class Guess:
    """Sees whatever the seams of a one-piece mesh show."""

    name = "guess"

    def articulate(self, mesh):
        return SeamsArticulator().articulate(mesh)


def test_what_is_expected_is_found_or_counted():
    expected = stated_from({"parts": [{"kind": "drawer", "count": 3}]})
    made = StatedArticulator(expected, Guess()).articulate(drawers())
    assert [part.kind for part in made.parts[1:]] == ["drawer"] * 3
    too_many = stated_from({"parts": [{"kind": "drawer", "count": 4}]})
    with pytest.raises(InputRejected, match="found 3 of 4 drawers") as caught:
        StatedArticulator(too_many, Guess()).articulate(drawers())
    assert caught.value.code == "stated_part_not_found"


def opened_box(angle):
    """A box of half a metre with a lid of 40 mm that stands open about its back edge [rad]."""
    body = Manifold.cube([0.5, 0.4, 0.3])
    lid = Manifold.cube([0.5, 0.4, 0.04]).translate([0.0, -0.4, 0.0])
    lid = lid.rotate([-float(np.degrees(angle)), 0.0, 0.0]).translate([0.0, 0.4, 0.3])
    return mesh_of(body + lid, 0.05)


@pytest.mark.parametrize("degrees", [70.0, 90.0])
def test_a_lid_that_is_drawn_open_is_closed_first(degrees):
    mesh = opened_box(np.radians(degrees))
    seam = 0.3 / float(mesh.extents[2])
    lid = {"kind": "lid", "side": "front", "box": [0, seam, 1, 1], "hinge": "back"}
    made = articulated(mesh, {**lid, "drawn": degrees})[0]
    low, high = box_of(made, 1)
    assert low == pytest.approx([0.0, 0.0, 0.3], abs=FINE)
    assert high == pytest.approx([0.5, 0.4, 0.34], abs=FINE)
    assert made.joints[0].lower == 0.0
    assert made.joints[0].upper >= np.radians(degrees) - 1e-9


def test_a_part_without_a_place_beside_placed_ones_is_not_dropped():
    door = {"kind": "door", "side": "front", "box": [0, 0.68, 1, 1]}
    with pytest.raises(InputRejected, match=r"parts\[1\] \(drawer\): has no side and box"):
        articulated(fridge(), door, {"kind": "drawer"})
