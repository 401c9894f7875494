"""What others propose and the detector sees goes on moving; what it alone sees is added."""

import re
from dataclasses import replace

import numpy as np
import pytest
from tests.samples import one_piece
from tests.samples.says import Says

pytest.importorskip("torch")

from asset_factory.factory.articulate.detected import DetectedArticulator
from asset_factory.factory.articulate.detected.agreement import load_agreement
from asset_factory.factory.articulate.detected.facing import without_backs
from asset_factory.factory.articulate.rigid import rigid_articulation
from asset_factory.factory.articulation import Articulation, Joint, JointKind, Part
from asset_factory.factory.part import PartKind, PartSource, Proposer
from asset_factory.learn.detector.still import make_still
from asset_factory.learn.objects import make_object


def detected(said):
    return DetectedArticulator(Says(said)).hypotheses(said.mesh)


def unmoving(kind, seed):
    return rigid_articulation(make_object(kind, seed).mesh, "auto", ())


def with_part(articulation, faces, kind=PartKind.PART, confidence=0.5, source=None):
    """Return the articulation with some of its body's faces as a part that slides to the back."""
    base = articulation.parts[0]
    parts = [replace(base, faces=np.setdiff1d(base.faces, faces)), *articulation.parts[1:]]
    parts.append(Part("part_0", faces, confidence, kind=kind, source=source))
    joint = Joint(
        "part_0_slide", JointKind.PRISMATIC, 0, len(parts) - 1, np.array([0.0, 1.0, 0.0]),
        np.zeros(3), 0.0, 0.1, confidence=confidence,
    )  # fmt: skip
    return replace(articulation, parts=tuple(parts), joints=(*articulation.joints, joint))


def test_doors_that_nobody_proposes_are_added_and_say_who_saw_them():
    made = detected(unmoving("fridge", 4))[0]
    doors = [part for part in made.parts if part.kind is PartKind.DOOR]
    assert len(doors) == len(make_object("fridge", 4).movable_joints)
    assert {part.source.proposer for part in doors} == {Proposer.DETECTOR}
    assert all(0.5 <= part.confidence <= 1.0 for part in doors)
    assert all(abs(joint.axis[2]) > 0.99 for joint in made.joints)
    assert [weights.file for weights in made.weights] == ["detector.safetensors"]


def test_what_it_does_not_see_stays_fixed_and_what_it_sees_moves():
    truth = make_object("fridge", 4)
    parts = tuple(replace(part, confidence=0.6) for part in truth.parts)
    proposed = Articulation(truth.mesh, parts, truth.joints, "auto")
    base = proposed.parts[0]
    middles = truth.mesh.vertices[truth.mesh.faces[base.faces]].mean(axis=1)
    rear = base.faces[middles[:, 1] > np.quantile(middles[:, 1], 0.8)]
    made = detected(with_part(proposed, rear))[0]
    assert [part.name for part in made.parts] == [part.name for part in proposed.parts]
    assert len(made.mesh.faces) == len(truth.mesh.faces)
    assert [part.confidence for part in made.parts[1:]] == [j.confidence for j in made.joints]
    assert all(0.6 < joint.confidence <= 1.0 for joint in made.joints)


@pytest.mark.parametrize(("proposer", "moves"), [(Proposer.RULES, True), (Proposer.NETWORK, False)])
def test_knobs_that_rules_find_move_alone_and_guessed_ones_do_not(proposer, moves):
    table = make_still("still_table", np.random.default_rng(4)).mesh
    source = PartSource("knob", proposer, 0.5, {})
    said = rigid_articulation(table, "auto", ())
    made = detected(with_part(said, np.arange(2), PartKind.KNOB, source=source))[0]
    assert bool(made.movable_joints) is moves


@pytest.mark.parametrize(
    ("said", "moves"),
    [(unmoving("dresser", 1), True), (make_still("still_table", np.random.default_rng(4)), False)],
    ids=["dresser", "table"],
)
def test_a_drawer_that_rules_find_moves_where_something_opens(said, moves):
    source = PartSource("0", Proposer.RULES, 0.5, {})
    said = rigid_articulation(said.mesh, "auto", ())
    drawer = with_part(said, front_of(said.mesh, 0.1), PartKind.DRAWER, source=source)
    assert bool(detected(drawer)[0].movable_joints) is moves


@pytest.mark.parametrize(
    ("kind", "confidence", "moving"),
    [
        ("fridge", 0.3, ["door", "door"]),
        ("fridge", 0.9, ["flap"]),
        ("window", 0.3, ["door", "door", "flap"]),
    ],
)
def test_of_what_opens_on_opposite_sides_the_surer_moves(kind, confidence, moving):
    truth = make_object("fridge", 4)
    body, *doors = (replace(part, confidence=0.4, kind=PartKind.DOOR) for part in truth.parts)
    middles = truth.mesh.vertices[truth.mesh.faces[body.faces]].mean(axis=1)[:, 1]
    rear = body.faces[middles > np.quantile(middles, 0.9)]
    said = replace(truth, parts=(replace(body, kind=PartKind.BODY), *doors))
    made = without_backs(with_part(said, rear, PartKind.FLAP, confidence), kind)
    assert [part.kind for part in made.parts[1:]] == moving


def front_of(mesh, share):
    """Return the faces in front of a share of an object's depth."""
    middles = mesh.vertices[mesh.faces].mean(axis=1)[:, 1]
    low, high = mesh.bounds[:, 1]
    return np.flatnonzero(middles < low + share * (high - low))


def test_a_part_that_a_network_believes_gives_way_to_drawers_that_are_seen_there():
    said = unmoving("dresser", 1)
    made = detected(with_part(said, front_of(said.mesh, 0.1), confidence=0.9))[0]
    drawers = len(make_object("dresser", 1).movable_joints)
    assert [part.kind for part in made.parts[1:]] == [PartKind.DRAWER] * drawers


def test_of_one_piece_what_rules_take_for_a_door_gives_way_to_drawers_that_are_seen_there():
    mesh = one_piece.proud_drawers()
    source = PartSource("0", Proposer.RULES, 0.9, {})
    said = rigid_articulation(mesh, "auto", ())
    made = detected(with_part(said, front_of(mesh, 0.1), PartKind.DOOR, source=source))[0]
    assert [part.kind for part in made.parts[1:]] == [PartKind.DRAWER] * 2


@pytest.mark.parametrize("share", [0.0, 1.0])
def test_a_lid_that_is_proposed_with_its_hinge_elsewhere_is_hung_where_its_sides_say(share):
    truth = make_object("chest", 1)
    (joint,) = truth.movable_joints
    lid = truth.part_mesh(joint.child).bounds
    moved = joint.origin + share * np.array([0.0, lid[0, 1] - joint.origin[1], 0.0])
    sure = tuple(replace(part, confidence=0.9, kind=PartKind.PART) for part in truth.parts)
    proposed = replace(truth, parts=sure, joints=(replace(joint, origin=moved),))
    (made,) = detected(proposed)[0].movable_joints
    assert made.origin[1] == pytest.approx(joint.origin[1], abs=0.15 * np.ptp(lid[:, 1]))
    assert abs(made.axis[0]) > 0.99


def test_a_knob_on_a_door_that_is_seen_is_its_pull():
    truth = make_object("fridge", 4)
    said = unmoving("fridge", 4)
    source = PartSource("knob", Proposer.RULES, 0.63, {})
    made = detected(with_part(said, front_of(said.mesh, 0.02), PartKind.KNOB, source=source))[0]
    assert [part.kind for part in made.parts[1:]] == [PartKind.DOOR] * len(truth.movable_joints)


def test_a_doors_lever_that_is_all_a_network_sees_gives_way_to_the_door():
    truth = make_object("door", 0)
    lever = truth.parts[2].faces
    # Of the second no side shows enough to ask about it.
    for faces in (lever, lever[:2]):
        made = detected(with_part(rigid_articulation(truth.mesh, "auto", ()), faces))[0]
        assert [part.kind for part in made.parts[1:]] == [PartKind.DOOR]


def test_a_table_stays_shut_and_says_why():
    table = make_still("still_table", np.random.default_rng(4))
    (only,) = detected(rigid_articulation(table.mesh, "auto", ()))
    assert not only.movable_joints
    (looks,) = only.notes
    kind = r"it looks like a [a-z ]+ with probability \d\.\d\d"
    assert re.fullmatch(kind + r"; it has something to open with probability 0\.\d\d", looks)


def test_agreement_rises_with_what_is_seen():
    agreement = load_agreement()
    seen = np.array([0.9, np.sqrt(0.9), 0.5, 0.0])
    closed = np.array([0.1, np.sqrt(0.1), 1.0, 1.0])
    unseen = np.array([0.0, 0.0, 1.0, 1.0])
    assert agreement.panel.chance(seen) > agreement.least > agreement.panel.chance(unseen)
    assert agreement.panel.chance(closed) > agreement.panel.chance(closed * [1.0, 1.0, 0.0, 0.0])
    assert agreement.lid.chance(np.array([0.9])) > agreement.least
    assert agreement.lid.chance(np.array([0.0])) < agreement.least
    guessed = np.array([0.6, np.sqrt(0.6), 0.0, 1.0])
    assert agreement.proposed.chance(guessed) > agreement.least
    assert agreement.proposed.chance(guessed * [0.0, 0.0, 1.0, 1.0]) < agreement.least


def test_what_is_seen_and_left_fixed_is_told():
    made = make_object("fridge", 4)
    says = Says(rigid_articulation(made.mesh, "auto", ()))
    (only,) = DetectedArticulator(says, least=0.999).hypotheses(made.mesh)
    assert not only.movable_joints
    assert "a door is seen on the front and left fixed" in only.notes[0]
    assert "want 1.00" in only.notes[0]
