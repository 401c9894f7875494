"""Stated parts are found on the mesh: boxes go to the seams they mean, joints to their edges."""

from contextlib import suppress

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from manifold3d import CrossSection, Manifold
from one_piece import doors, drawers, fridge, mesh_of
from refusing import refusal
from says import Says
from stated_parts import FINE, articulated, block, box_of

from asset_factory.factory.articulate.locate import located
from asset_factory.factory.articulate.stated import StatedArticulator
from asset_factory.factory.articulation import JointKind, rotation_about
from asset_factory.factory.errors import ConfigError, InputRejected
from asset_factory.factory.intake.stated import Hinge, StatedKind, stated_from
from asset_factory.factory.part import Proposer

#: The fridge's upper door, and the two of ``doors``.
DOOR = {"kind": "door", "side": "front", "box": [0, 0.68, 1, 1]}
LEFT = {"kind": "door", "side": "front", "box": [0.03, 0.03, 0.5, 0.97], "hinge": "left"}
RIGHT = {"kind": "door", "side": "front", "box": [0.5, 0.03, 0.97, 0.97], "hinge": "right"}


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


def test_edges_of_something_thin_do_not_meet_at_one_seam():
    part = {"kind": "drawer", "side": "front", "box": [0.05, 0.66, 0.95, 0.69]}
    (made, *_) = articulated(drawers(), part)
    low, high = box_of(made, 1)
    assert high[2] - low[2] == pytest.approx(0.027, abs=FINE / 2.0)


def test_a_door_is_hinged_where_it_is_said():
    for hinge, x, sign in (("left", 0.0, -1.0), ("right", 0.6, 1.0)):
        (made, *_) = articulated(fridge(), {**DOOR, "hinge": hinge})
        assert made.joints[0].origin[0] == pytest.approx(x, abs=FINE)
        assert made.joints[0].axis == pytest.approx([0.0, 0.0, sign], abs=1e-9)
        assert box_of(made, 1)[0][2] == pytest.approx(1.1, abs=FINE)


def test_a_door_leaves_its_narrow_frame_though_the_mesh_has_a_crumb():
    groove = block([0.05, -0.01, -1.0], [0.95, 0.02, 1.95]) - block([0.07, -1, -2], [0.93, 1, 1.93])
    crumb = block([0.8, -0.03, 1.0], [0.82, -0.01, 1.02])
    mesh = mesh_of(block([0.0, 0.0, 0.0], [1.0, 0.1, 2.0]) - groove + crumb, 0.05)
    part = {"kind": "door", "side": "front", "box": [0.055, 0, 0.945, 0.97], "hinge": "left"}
    low, high = box_of(articulated(mesh, part)[0], 1)
    assert low[0] == pytest.approx(0.05, abs=1.5 * FINE)
    assert high[[0, 2]] == pytest.approx([0.95, 1.95], abs=1.5 * FINE)


@pytest.mark.parametrize(("depth", "whole"), [(0.06, True), (0.5, False)])
def test_a_door_that_nothing_lies_behind_moves_whole(depth, whole):
    frame = block((0.0, 0.0, 0.0), (1.0, depth, 2.0))
    part = {"kind": "door", "side": "front", "box": [0.1, 0.05, 0.9, 0.95], "hinge": "left"}
    (made, *_) = articulated(mesh_of(frame, 0.1), part)
    low, high = box_of(made, 1)
    assert low[1] == pytest.approx(0.0)
    assert high[1] == pytest.approx(depth, abs=1e-6) if whole else high[1] < 0.1


def test_without_a_hinge_both_are_tried_the_handles_other_side_first():
    first, second = articulated(fridge(), DOOR)
    assert first.joints[0].origin[0] == pytest.approx(0.6, abs=FINE)
    assert second.joints[0].origin[0] == pytest.approx(0.0, abs=FINE)


def test_a_stated_name_is_no_other_parts():
    (made,) = articulated(doors(), LEFT, {**RIGHT, "name": "door_0"})
    assert [part.name for part in made.parts] == ["base", "door_1", "door_0"]


def test_a_lid_is_what_is_above_its_box_hinged_across():
    (made, *_) = articulated(fridge(), {"kind": "lid", "side": "front", "box": [0, 0.69, 1, 1]})
    low, _ = box_of(made, 1)
    assert low[2] == pytest.approx(1.1, abs=FINE)
    assert abs(made.joints[0].axis[0]) == pytest.approx(1.0)
    assert made.joints[0].origin[1] > 0.5


def test_stated_limits_are_degrees_and_millimetres():
    drawer = {"kind": "drawer", "side": "front", "box": [0.05, 0.38, 0.95, 0.67]}
    (turned, *_) = articulated(fridge(), {**DOOR, "hinge": "left", "range": [0, 90]})
    assert turned.joints[0].upper == pytest.approx(np.pi / 2.0)
    (slid, *_) = articulated(drawers(), {**drawer, "range": [0, 250]})
    assert slid.joints[0].upper == pytest.approx(0.25)


def test_the_front_may_look_anywhere():
    door = {**DOOR, "hinge": "left"}
    straight = articulated(fridge(), door)[0].joints[0]
    for front, quarters in (("x", 1), ("y", 2), ("-x", 3)):
        turn = np.round(rotation_about([0.0, 0.0, 1.0], quarters * np.pi / 2.0), 12)
        made = articulated(fridge().turned(turn), door, front=front)[0].joints[0]
        assert made.origin == pytest.approx(turn @ straight.origin, abs=FINE)
        assert made.axis == pytest.approx(turn @ straight.axis, abs=1e-9)


def test_a_box_beside_the_mesh_says_what_it_shows():
    articulated(fridge(), {"kind": "door", "side": "left", "box": [0.0, 0.0, 1.0, 1.0]})
    drawer = {"kind": "drawer", "side": "front", "box": [0.0, 0.6, 1.0, 1.0]}
    found = refusal(articulated, fridge(), DOOR, drawer)
    assert found.code == "stated_part_not_found"
    assert "parts[0] (door) and parts[1] (drawer): share" in found.message


def test_nothing_opens_where_that_is_said():
    (made,) = articulated(fridge(), opens=False)
    assert made.movable_joints == ()


EDGES = st.sampled_from([0.0, 0.001, 0.05, 0.1, 0.48, 0.52, 0.9, 0.996, 1.0])
PARTS = st.fixed_dictionaries(
    {
        "kind": st.sampled_from([each.value for each in StatedKind]),
        "side": st.sampled_from(["front", "back", "left", "top"]),
        "box": st.tuples(EDGES, EDGES, EDGES, EDGES),
    },
    optional={
        "hinge": st.sampled_from([each.value for each in Hinge]),
        "drawn": st.sampled_from(["open", 30]),
        "range": st.sampled_from([(-30, 0), (-10, 90)]),
        "also": st.just([{"side": "top", "box": [0.1, 0.0, 0.9, 0.6]}]),
        "alternatives": st.just([{"kind": "knob"}]),
    },
)


@settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.lists(PARTS, min_size=1, max_size=3))
def test_whatever_is_stated_is_an_articulation_or_a_sentence(parts):
    with suppress(InputRejected, ConfigError):
        for made in articulated(doors(), *parts):
            assert all(len(part.faces) for part in made.parts)
            located(made)


def test_a_part_has_the_name_and_carries_what_was_stated():
    door = {**DOOR, "name": "freezer", "hinge": "right"}
    knob = {"kind": "knob", "side": "front", "box": [0.05, 0.7, 0.15, 0.9], "parent": "freezer"}
    made = articulated(fridge(), door, {**knob, "name": "grip"})[0]
    assert [part.name for part in made.parts] == ["base", "freezer", "grip"]
    assert [joint.name for joint in made.joints] == ["freezer_hinge", "grip_turn"]
    assert made.joints[1].parent == 1
    assert {part.source.proposer for part in made.parts[1:]} == {"sidecar"}


def test_a_sidecar_of_another_mesh_is_refused():
    with pytest.raises(InputRejected, match=r"sides are 1\.00 : 1\.00 : 1\.00, this one's are"):
        articulated(fridge(), size=[2, 2, 2])
    articulated(fridge(), DOOR, size=[6, 6, 16])


def guess():
    """Who sees the three drawers of ``drawers``."""
    rows = ((0.07, 0.36), (0.38, 0.67), (0.69, 0.96))
    drawer = {"kind": "drawer", "side": "front"}
    said = stated_from(
        {"parts": [{**drawer, "box": [0.05, low, 0.95, high]} for low, high in rows]}
    )
    return StatedArticulator(said, None, Proposer.SIDES)


def test_what_is_expected_is_found_or_counted():
    expected = stated_from({"parts": [{"kind": "drawer", "count": 3}]})
    made = StatedArticulator(expected, guess()).articulate(drawers())
    assert [part.kind for part in made.parts[1:]] == ["drawer"] * 3
    too_many = stated_from({"parts": [{"kind": "drawer", "count": 4}]})
    found = refusal(StatedArticulator(too_many, guess()).articulate, drawers())
    assert found.code == "stated_part_not_found"
    assert "found 3 of 4 drawers" in found.message


def test_what_is_not_expected_stays_on_what_holds_it():
    drawer = {"kind": "drawer", "side": "front", "box": [0.05, 0.378, 0.95, 0.667], "name": "low"}
    knob = {"kind": "knob", "side": "front", "box": [0.36, 0.5, 0.64, 0.55], "parent": "low"}
    (whole, *_) = articulated(drawers(), drawer, knob)
    expected = stated_from({"parts": [{"kind": "drawer"}]})
    made = StatedArticulator(expected, Says(whole)).articulate(drawers())
    moving = np.concatenate([part.faces for part in whole.parts[1:]])
    assert len(whole.parts) == 3
    assert made.parts[1].faces.tolist() == sorted(moving.tolist())


@pytest.mark.parametrize("degrees", [70.0, 90.0])
def test_a_lid_that_is_drawn_open_is_closed_first(degrees):
    # A box of half a metre with a lid of 40 mm that stands open about its back edge.
    body = Manifold.cube([0.5, 0.4, 0.3])
    plate = Manifold.cube([0.5, 0.4, 0.04]).translate([0.0, -0.4, 0.0])
    mesh = mesh_of(body + plate.rotate([-degrees, 0.0, 0.0]).translate([0.0, 0.4, 0.3]), 0.05)
    seam = 0.3 / float(mesh.extents[2])
    lid = {"kind": "lid", "side": "front", "box": [0, seam, 1, 1], "hinge": "back"}
    made = articulated(mesh, {**lid, "drawn": degrees})[0]
    low, high = box_of(made, 1)
    assert low == pytest.approx([0.0, 0.0, 0.3], abs=FINE)
    assert high == pytest.approx([0.5, 0.4, 0.34], abs=FINE)
    assert made.joints[0].lower == 0.0
    assert made.joints[0].upper >= np.radians(degrees) - 1e-9


def test_a_part_without_a_place_is_looked_for_beside_placed_ones():
    placed = {"kind": "drawer", "side": "front", "box": [0.05, 0.378, 0.95, 0.667], "name": "mid"}
    stated = stated_from({"parts": [placed, {"kind": "drawer", "count": 2}]})
    made = StatedArticulator(stated, guess()).articulate(drawers())
    assert [part.name for part in made.parts] == ["base", "mid", "drawer_0", "drawer_1"]
    assert [part.source.proposer for part in made.parts[1:]] == ["sidecar", "sides", "sides"]
    stated = stated_from({"parts": [placed, {"kind": "drawer", "count": 3}]})
    with pytest.raises(InputRejected, match="found 2 of 3 drawers"):
        StatedArticulator(stated, guess()).articulate(drawers())
    with pytest.raises(InputRejected, match=r"parts\[1\] \(drawer\): has no side and box"):
        StatedArticulator(stated).articulate(drawers())


def test_alternatives_are_tried_after_what_is_stated():
    others = [{"hinge": "right"}, {"kind": "drawer"}]
    made = articulated(fridge(), {**DOOR, "hinge": "left", "alternatives": others})
    assert [each.parts[1].kind for each in made] == ["door", "door", "drawer"]
    assert made[0].joints[0].origin[0] == pytest.approx(0.0, abs=FINE)
    assert made[1].joints[0].origin[0] == pytest.approx(0.6, abs=FINE)
    assert made[2].joints[0].kind is JointKind.PRISMATIC


def test_a_lid_ends_where_another_begins():
    lids = [block([x, 0.0, 0.61], [x + 0.49, 0.5, 0.71]) for x in (0.0, 0.51)]
    post = block([0.1, 0.1, 0.59], [0.9, 0.4, 0.62])
    mesh = mesh_of(block([0.0, 0.0, 0.0], [1.0, 0.5, 0.6]) + post + lids[0] + lids[1], 0.05)
    seam = 0.6 / 0.71
    left = {"kind": "lid", "side": "front", "box": [0.0, seam, 0.52, 1.0], "hinge": "left"}
    right = {"kind": "lid", "side": "front", "box": [0.48, seam, 1.0, 1.0], "hinge": "back"}
    made = articulated(mesh, left, right)[0]
    assert box_of(made, 1)[1][0] == pytest.approx(0.5, abs=FINE)
    assert box_of(made, 2)[0][0] == pytest.approx(0.5, abs=FINE)
    assert made.joints[0].origin[0] == pytest.approx(0.0, abs=FINE)
    assert abs(made.joints[0].axis[1]) == pytest.approx(1.0)
    assert made.joints[1].origin[1] == pytest.approx(0.5, abs=FINE)


def test_a_sloping_lid_is_parallel_to_what_is_seen_of_it():
    side = [[0.0, 0.0], [0.6, 0.0], [0.6, 0.5], [0.0, 0.3]]
    desk = CrossSection([side]).extrude(0.8)
    pose = np.array([[0.0, 0.0, 1.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]])
    mesh = mesh_of(desk.transform(pose), 0.05)
    lid = {"kind": "lid", "side": "top", "box": [0.0, 0.0, 1.0, 1.0], "hinge": "back"}
    made = articulated(mesh, lid)[0]
    assert made.joints[0].origin[1:] == pytest.approx([0.6, 0.5], abs=FINE)
    assert abs(made.joints[0].axis[0]) == pytest.approx(1.0)
    # All along the slope the body begins as far below it: at its front the lid is no thicker.
    assert 0.2 < box_of(made, 1)[0][2] < 0.31
    assert box_of(made, 0)[1][2] > 0.4


def test_a_wheel_turns_about_its_hub_and_a_lever_about_its_edge():
    body = block([-0.2, 0.1, 0.0], [0.2, 0.5, 1.0]) + block(
        [-0.05, -0.05, 0.75], [0.05, 0.15, 0.85]
    )
    up = block([-0.05, -0.07, 0.75], [0.05, -0.03, 1.25])
    mesh = mesh_of(body + up + block([-0.05, -0.07, 0.75], [0.65, -0.03, 0.85]), 0.05)
    width, height = 0.2 + 0.65, 1.25
    sail = [0.15 / width, 0.75 / height, 1.0, 1.0]
    made = articulated(mesh, {"kind": "sail", "side": "front", "box": sail})[0]
    assert (made.parts[1].kind, made.joints[0].kind) == ("wheel", JointKind.CONTINUOUS)
    assert abs(made.joints[0].axis[1]) == pytest.approx(1.0)
    assert box_of(made, 1)[1][1] < 0.1
    lever = {"kind": "lever", "side": "front", "box": [0.15 / width, 0.6, 1.0, 0.68]}
    made = articulated(mesh, {**lever, "hinge": "left"})[0]
    assert made.joints[0].kind is JointKind.REVOLUTE
    assert made.joints[0].origin[0] == pytest.approx(-0.05, abs=FINE)


def test_a_lid_and_a_door_that_share_their_surface_are_refused():
    lid = {"kind": "lid", "side": "front", "box": [0, 0.3, 1, 1]}
    door = {"kind": "door", "side": "right", "box": [0.1, 0.4, 0.9, 0.9]}
    with pytest.raises(InputRejected, match=r"parts\[1\] \(door\): other stated parts take"):
        articulated(fridge(), lid, door)


def test_a_piece_that_a_box_means_is_the_part_and_nothing_is_cut():
    body = block([0.0, 0.02, 0.0], [0.5, 0.4, 1.0])
    fronts = [block([0.03, -0.01, z], [0.47, 0.01, z + 0.4]) for z in (0.05, 0.55)]
    mesh = mesh_of(body + fronts[0] + fronts[1], 0.05)
    part = {"kind": "door", "side": "front", "box": [0.09, 0.02, 0.97, 0.42], "hinge": "left"}
    made, cut = articulated(mesh, part)
    assert len(made.parts[0].faces) + len(made.parts[1].faces) == len(made.mesh.faces)
    assert box_of(made, 1) == pytest.approx(np.array([[0.03, -0.01, 0.05], [0.47, 0.01, 0.45]]))
    assert made.joints[0].origin[0] == pytest.approx(0.03, abs=FINE / 4.0)
    # Where the piece is not it, all that is in the region of its box is.
    assert box_of(cut, 1)[1][1] > 0.015


def test_boxes_drawn_over_one_another_are_the_pieces_that_they_mean():
    fronts = [block([0.01, -0.02, z], [0.49, 0.0, z + 0.18]) for z in (0.01, 0.21, 0.41)]
    mesh = mesh_of(block([0.0, 0.001, 0.0], [0.5, 0.4, 1.0]) + Manifold.compose(fronts), 0.1)
    boxes = [[0.0, 0.0, 1.0, 0.24], [0.05, 0.17, 1.0, 0.43], [0.0, 0.37, 0.95, 0.55]]
    drawers = [{"kind": "drawer", "side": "front", "box": box} for box in boxes]
    made = articulated(mesh, *drawers)[0]
    assert [box_of(made, part)[0][2] for part in (1, 2, 3)] == pytest.approx([0.01, 0.21, 0.41])


def test_a_door_in_its_frame_takes_pane_and_handles_along():
    # As deep as all of the object, by its handles.
    frame = block([0.0, 0.0, 0.0], [1.0, 0.1, 2.0]) - block([0.06, -1.0, -1.0], [0.94, 1.0, 1.94])
    leaf = block([0.07, 0.02, 0.0], [0.93, 0.06, 1.93]) - block([0.2, -1, 0.2], [0.5, 1, 1.7])
    handles = block([0.8, -0.05, 0.9], [0.85, 0.15, 1.0])
    pane = block([0.21, 0.035, 0.21], [0.49, 0.045, 1.69])
    behind = block([0.8, 0.065, 1.1], [0.85, 0.14, 1.2])
    mesh = mesh_of(frame + (leaf + handles) + pane + behind, 0.1)
    part = {"kind": "door", "side": "front", "box": [0.07, 0.0, 0.93, 0.97], "hinge": "left"}
    made = articulated(mesh, part)[0]
    leaf_box = np.array([[0.07, -0.05, 0.0], [0.93, 0.15, 1.93]])
    assert box_of(made, 1) == pytest.approx(leaf_box)
    assert box_of(made, 0) == pytest.approx(np.array([[0.0, 0.0, 0.0], [1.0, 0.1, 2.0]]))
    left = made.mesh.vertices[made.mesh.faces[made.parts[0].faces]]
    assert not ((left[..., 0] > 0.2) & (left[..., 0] < 0.9) & (left[..., 2] < 1.9)).any()


@pytest.mark.parametrize("off", [-0.02, 0.0, 0.02])
def test_panes_between_a_windows_bars_turn_with_it_about_its_edge(off):
    frame = block([0.0, 0.0, 0.0], [0.7, 0.08, 1.1]) - block([0.04, -1, 0.04], [0.66, 1, 1.06])
    ends = [(0.05, 0.12, 0.05, 1.05), (0.58, 0.65, 0.05, 1.05)]
    ends += [(0.121, 0.579, 0.05, 0.12), (0.121, 0.579, 0.98, 1.05)]
    bars = [block([x0, 0.01, z0], [x1, 0.05, z1]) for x0, x1, z0, z1 in ends]
    pane = block([0.122, 0.028, 0.122], [0.578, 0.032, 0.978])
    mesh = mesh_of(frame + bars[0] + bars[1] + bars[2] + bars[3] + pane, 0.1)
    box = [0.07 + off, 0.05 + off, 0.93 + off, 0.95 + off]
    made = articulated(mesh, {"kind": "door", "side": "front", "box": box, "hinge": "left"})[0]
    sash = np.array([[0.05, 0.01, 0.05], [0.65, 0.05, 1.05]])
    assert box_of(made, 1) == pytest.approx(sash)
    assert made.joints[0].origin[0] == pytest.approx(0.05)
    assert len(made.parts[0].faces) == len(mesh_of(frame, 0.1).faces)


def test_a_glass_within_the_ring_of_a_door_is_the_doors_and_a_lever_before_it_is_not():
    body = block([0.0, 0.0, 0.0], [0.6, 0.6, 0.8]) - block([0.2, -1, 0.3], [0.4, 0.5, 0.5])
    circle = CrossSection.circle(0.04, 24).translate((0.16, 0.0))
    ring = circle.revolve(48).rotate((90, 0, 0)).translate((0.3, -0.041, 0.4))
    glass = Manifold.sphere(0.11, 48).scale((1.0, 0.3, 1.0)).translate((0.3, -0.061, 0.4))
    lever = block([0.25, -0.2, 0.38], [0.3, -0.15, 0.4])
    part = {"kind": "door", "side": "front", "box": [1 / 6, 0.25, 5 / 6, 0.75], "hinge": "left"}
    made = articulated(mesh_of(body + ring + glass + lever, 0.1), part)[0]
    assert box_of(made, 1) == pytest.approx(np.array([[0.1, -0.094, 0.2], [0.5, -0.001, 0.6]]))


def test_a_drawer_takes_its_bottom_along_and_stays_in_its_rails():
    case = block([0.0, 0.0, 0.0], [0.6, 0.9, 0.5]) - block([0.05, -1.0, 0.3], [0.55, 0.85, 0.45])
    tray = block([0.06, -0.02, 0.31], [0.54, 0.4, 0.44]) - block([0.08, 0.02, 0.0], [0.52, 0.38, 1])
    bottom = block([0.09, 0.1, 0.32], [0.51, 0.37, 0.325])
    ceiling = block([0.09, 0.1, 0.4395], [0.51, 0.37, 0.44])
    mesh = mesh_of(case + tray + bottom + ceiling, 0.1)
    part = {"kind": "drawer", "side": "front", "box": [0.1, 0.62, 0.9, 0.88]}
    made = articulated(mesh, part)[0]
    assert made.joints[0].upper == pytest.approx(0.42, abs=FINE)
    moved = made.part_mesh(1).vertices
    assert ((moved[:, 0] > 0.085) & (moved[:, 2] < 0.326) & (moved[:, 2] > 0.315)).any()
    assert not (moved[:, 2] == np.float32(0.4395)).any()
    ranged = articulated(mesh, {**part, "range": [0, 600]})[0]
    assert ranged.joints[0].upper == pytest.approx(0.6)
