"""What is round turns or lifts: caps, lids, levers, turntables, wheels, the knobs of a cooktop."""

import numpy as np
import trimesh
from plain_solids import box_between as box
from plain_solids import carcass
from test_geometric import articulate

from asset_factory.factory.articulation import JointKind
from asset_factory.factory.mesh import Mesh


def lathe(profile, center=(0.0, 0.0), axis=2):
    """A closed solid of revolution of (radius, height) pairs, about z or an axis at ``center``."""
    outline = [(0.0, profile[0][1]), *profile, (0.0, profile[-1][1])]
    made = trimesh.creation.revolve(np.array(outline), sections=24)
    turned = np.asarray(made.vertices)[:, {1: [1, 2, 0], 2: [0, 1, 2]}[axis]]
    turned[:, [other for other in range(3) if other != axis]] += center
    return Mesh.from_triangles(turned, made.faces)


BOTTLE = lathe([(0.04, 0.0), (0.04, 0.2), (0.03, 0.22)])


def test_the_cap_of_a_bottle_turns_about_its_axis():
    articulation = articulate(BOTTLE, lathe([(0.033, 0.215), (0.033, 0.25)]))
    assert [(j.name, j.kind) for j in articulation.joints] == [("cap_0_turn", JointKind.CONTINUOUS)]
    assert np.allclose(articulation.joints[0].axis, [0, 0, 1])
    assert np.allclose(articulation.joints[0].origin[:2], 0.0, atol=1e-9)
    assert any("assumed to turn" in note for note in articulation.notes)


def test_the_lid_of_a_pot_is_lifted_by_its_knob():
    pot = lathe([(0.15, 0.0), (0.15, 0.15)])
    lid = lathe([(0.14, 0.151), (0.13, 0.17), (0.02, 0.18), (0.02, 0.21)])
    joint = articulate(pot, lid).joints[0]
    assert joint.kind is JointKind.PRISMATIC
    assert np.allclose(joint.axis, [0, 0, 1])
    assert joint.lower == 0.0 < joint.upper < 0.06


def test_a_lever_on_a_round_body_turns_by_half_a_turn():
    post = lathe([(0.045, 0.0), (0.045, 0.1)])
    hub = lathe([(0.032, 0.1), (0.032, 0.14)])
    arm = box((0.03, -0.015, 0.105), (0.18, 0.015, 0.135))
    joint = articulate(post, hub, arm).joints[0]
    assert (joint.name, joint.kind) == ("lever_0_hinge", JointKind.REVOLUTE)
    assert np.allclose(joint.origin[:2], 0.0, atol=1e-9)


def test_a_vase_on_a_table_and_a_round_table_stay():
    table = [box((0, 0, 0.7), (1.2, 0.8, 0.74)), box((0.5, 0.3, 0.0), (0.7, 0.5, 0.7))]
    vase = lathe([(0.08, 0.74), (0.1, 0.85), (0.05, 1.0)], (0.6, 0.4))
    assert articulate(*table, vase).joints == ()
    column = lathe([(0.05, 0.0), (0.05, 0.7)])
    top = lathe([(0.5, 0.7), (0.5, 0.73)])
    assert articulate(column, top).joints == ()


CASE = [
    *carcass(0.5, 0.4, 0.3),
    box((0.001, -0.03, 0.001), (0.499, -0.001, 0.299)),
    box((0.45, -0.06, 0.05), (0.46, -0.031, 0.25)),
]
PLATE = lathe([(0.12, 0.03), (0.12, 0.035)], (0.25, 0.2))


def test_a_round_plate_in_a_closed_case_turns():
    articulation = articulate(*CASE, PLATE)
    assert {j.name for j in articulation.joints} == {"door_0_hinge", "turntable_0_turn"}
    assert np.allclose(articulation.joint("turntable_0_turn").origin[:2], [0.25, 0.2], atol=1e-6)


def test_plates_in_a_row_and_a_plate_without_a_case_stay():
    two = [lathe([(0.09, 0.03), (0.09, 0.035)], (x, 0.2)) for x in (0.13, 0.36)]
    assert {j.name for j in articulate(*CASE, *two).joints} == {"door_0_hinge"}
    assert articulate(box((0, 0, 0), (0.5, 0.4, 0.02)), PLATE).joints == ()


def test_the_wheels_of_a_cart_roll_about_their_axles():
    deck = box((0.0, 0.0, 0.12), (0.8, 0.5, 0.16))
    rail = box((0.0, 0.0, 0.16), (0.03, 0.5, 0.8))
    places = [(x, y) for x in (0.1, 0.7) for y in (0.02, 0.45)]
    wheels = [lathe([(0.06, y), (0.06, y + 0.03)], (x, 0.06), axis=1) for x, y in places]
    joints = articulate(deck, rail, *wheels).joints
    assert [j.kind for j in joints] == [JointKind.CONTINUOUS] * 4
    assert all(abs(j.axis[1]) > 0.999 and abs(j.origin[2] - 0.06) < 1e-6 for j in joints)


def test_round_feet_do_not_roll():
    top = box((0.0, 0.0, 0.1), (0.8, 0.5, 0.5))
    feet = [lathe([(0.05, 0.0), (0.05, 0.1)], (x, y)) for x in (0.1, 0.7) for y in (0.1, 0.4)]
    assert articulate(top, *feet).joints == ()


HOB = box((0.0, 0.0, 0.0), (0.6, 0.5, 0.05))


def knob_at(x, y):
    return lathe([(0.025, 0.0501), (0.02, 0.08)], (x, y))


def test_knobs_in_a_row_on_a_cooktop_turn():
    articulation = articulate(HOB, *(knob_at(0.1 + 0.1 * k, 0.06) for k in range(4)))
    assert [j.kind for j in articulation.joints] == [JointKind.CONTINUOUS] * 4
    assert all(abs(j.axis[2]) > 0.999 for j in articulation.joints)


def test_round_things_strewn_over_a_board_stay():
    places = ((0.1, 0.1), (0.4, 0.15), (0.2, 0.35), (0.5, 0.42))
    assert articulate(HOB, *(knob_at(x, y) for x, y in places)).joints == ()


def test_a_flat_knob_with_a_bar_across_turns_with_its_bar():
    knobs = []
    for x in (0.1, 0.2, 0.3):
        knobs += [lathe([(0.025, 0.0501), (0.025, 0.055)], (x, 0.06))]
        knobs += [box((x - 0.004, 0.04, 0.055), (x + 0.004, 0.08, 0.075))]
    articulation = articulate(HOB, *knobs)
    assert len(articulation.joints) == 3
    assert {len(part.faces) for part in articulation.parts[1:]} == {24 * 4 + 12}


def test_flat_discs_on_a_cooktop_are_no_knobs():
    discs = [lathe([(0.025, 0.0501), (0.025, 0.055)], (x, 0.06)) for x in (0.1, 0.2, 0.3)]
    assert articulate(HOB, *discs).joints == ()
