"""Meshes of several pieces are read from their sides: whole pieces, or parts of solid ones."""

from dataclasses import replace

import numpy as np
import pytest
from modelled_furniture import board, bookcase, creased_cupboard, drawer_chest, fridge

from asset_factory.factory.articulate.auto.articulator import AutoArticulator
from asset_factory.factory.articulate.auto.hidden import without_hidden
from asset_factory.factory.articulate.auto.sides import sightings
from asset_factory.factory.articulate.auto.trust import load_trust
from asset_factory.factory.articulate.proposal import Motion, Proposal
from asset_factory.factory.articulation import JointKind
from asset_factory.factory.config import AutoConfig, BuildConfig
from asset_factory.factory.geometry.components import connected_components
from asset_factory.factory.mesh import concatenate
from asset_factory.factory.part import PartKind, Proposer
from asset_factory.factory.views.view import Views

UP = (0.0, 0.0, 1.0)


class SeesNothing(AutoArticulator):
    """The automatic articulator with neither network nor rules of shape."""

    def proposals(self, mesh, areas):
        return ()


def shown(mesh):
    return sightings(Views(mesh, connected_components(mesh)))[0]


def by_sides_alone(mesh):
    config = BuildConfig()
    nobody = SeesNothing(None, (), load_trust(), config.particulate, AutoConfig())
    return tuple(each.articulation for each in nobody.hypotheses(mesh))


def test_a_drawer_is_its_plate_and_knob_whole():
    mesh = drawer_chest()
    pieces = connected_components(mesh)
    seen = shown(mesh)
    assert seen.mesh is mesh
    found = [sorted(set(pieces[each.faces])) for each in seen.found]
    assert sorted(found) == [[1, 3], [2, 4]]
    assert all(each.motion.kind is JointKind.PRISMATIC for each in seen.found)
    assert all(np.allclose(each.motion.axis, (0, -1, 0)) for each in seen.found)


def test_both_doors_of_a_fridge_open_away_from_their_handles():
    (found, *_) = by_sides_alone(fridge())
    assert [joint.kind for joint in found.movable_joints] == ["revolute"] * 2
    for joint in found.movable_joints:
        assert np.allclose(joint.axis, UP)
        assert joint.origin[0] == pytest.approx(0.6, abs=0.02)


def test_doors_of_one_piece_are_cut_apart_at_their_crease():
    mesh = creased_cupboard()
    seen = shown(mesh)
    assert len(seen.mesh.faces) > len(mesh.faces)
    assert len(seen.found) == 2
    assert not (seen.found[0].faces & seen.found[1].faces).any()
    middles = [
        seen.mesh.vertices[seen.mesh.faces[each.faces]].mean(axis=(0, 1))[0] for each in seen.found
    ]
    assert min(middles) < 0.45 < max(middles)


def test_nothing_is_cut_out_of_what_has_an_inside():
    assert not any(
        each.found for each in sightings(Views(bookcase(), connected_components(bookcase())))
    )
    assert not by_sides_alone(bookcase())[0].movable_joints


def two_faced(mesh):
    """A mesh whose every triangle is there once each way round: it has no inside."""
    twin = replace(mesh, faces=mesh.faces[:, ::-1], corner_uv=None, corner_normals=None)
    whole = concatenate((mesh, twin))
    # The twins share the vertices of the first.
    shared = np.concatenate([mesh.faces, twin.faces])
    return replace(whole, vertices=mesh.vertices, faces=shared)


def test_doors_are_cut_out_of_a_box_of_two_faced_sheets_but_not_of_shelves_in_one():
    sheets = two_faced(creased_cupboard())
    assert len(sheets.faces) == 2 * len(creased_cupboard().faces)
    assert len(shown(sheets).found) == 2
    shelves = two_faced(bookcase())
    assert not any(each.found for each in sightings(Views(shelves, connected_components(shelves))))


def test_proposals_are_carried_to_the_cut_mesh():
    mesh = creased_cupboard()
    seen = shown(mesh)
    first = Proposal(
        "door", connected_components(mesh) == 2, seen.found[0].motion, seen.found[0].signs
    )
    (carried,) = seen.carried((first,))
    knob = seen.mesh.vertices[seen.mesh.faces[carried.faces]]
    assert np.ptp(knob.reshape(-1, 3), axis=0) == pytest.approx([0.03, 0.032, 0.03], abs=1e-6)


def test_the_front_of_a_drawer_that_is_known_is_no_drawer_of_its_own():
    mesh = drawer_chest()
    pieces = connected_components(mesh)
    seen = shown(mesh)
    left = seen.beyond(seen.found, (np.isin(pieces, (0, 1, 3)),))
    assert [sorted(set(pieces[each.faces])) for each in left] == [[2, 4]]
    assert len(seen.beyond(seen.found, ())) == 2


def test_a_knob_goes_with_the_plate_that_it_alone_touches():
    mesh = drawer_chest()
    pieces = connected_components(mesh)
    seen = shown(mesh).found[0]
    bare = np.isin(pieces, np.setdiff1d(pieces[seen.faces], (3, 4)))
    config = BuildConfig()
    nobody = SeesNothing(None, (), load_trust(), config.particulate, AutoConfig())
    found = nobody.decide(Views(mesh), (replace(seen, faces=bare),))
    plate, knob = sorted(set(pieces[found.parts[1].faces]))
    assert (plate, knob) in {(1, 3), (2, 4)}


def test_beside_a_known_front_only_whole_pieces_are_added():
    seen = shown(fridge())
    lower, upper = seen.found
    assert seen.beside([lower], [upper.faces]) == [lower]

    mesh = creased_cupboard()
    cut = shown(mesh)
    left, right = cut.found
    known = np.zeros(len(mesh.faces), dtype=np.bool_)
    known[cut.cut.source[right.faces]] = True
    assert cut.beside([left], [known]) == []


def test_a_little_piece_that_no_side_shows_is_no_mover_by_the_networks_word_alone():
    chest = drawer_chest()
    runner = board((0.1, 0.1, 0.3), (0.12, 0.4, 0.32))
    mesh = concatenate([chest, runner])
    seen = shown(chest).found[0]
    word = {"learned": 1.0, "confidence": 4.0, "moves": 4.0, "agreement": 1.0}
    hidden = np.arange(len(mesh.faces)) >= len(chest.faces)
    knob = connected_components(mesh) == 3
    config = BuildConfig()
    nobody = SeesNothing(None, (), load_trust(), config.particulate, AutoConfig(least_confidence=0))
    made = [
        replace(seen, faces=faces, signs=word, proposer=Proposer.NETWORK)
        for faces in (hidden, knob)
    ]
    found = nobody.decide(Views(mesh), made)
    (joint,) = found.movable_joints
    assert knob[found.parts[joint.child].faces].all()


def test_a_rack_behind_a_door_may_move_and_a_pair_of_runners_may_not():
    oven = board((0.0, 0.0, 0.0), (0.6, 0.6, 0.8))
    bars = [board((x, 0.1, 0.4), (x + 0.01, 0.5, 0.41)) for x in np.linspace(0.1, 0.49, 9)]
    for pieces, kept in ((bars, True), (bars[::8], False)):
        mesh = concatenate([oven, *pieces])
        faces = np.arange(len(mesh.faces)) >= len(oven.faces)
        motion = Motion(JointKind.PRISMATIC, np.array([0.0, -1.0, 0.0]), np.zeros(3), 0.0, 0.3)
        said = Proposal(PartKind.PART, faces, motion, proposer=Proposer.NETWORK)
        assert (without_hidden(Views(mesh), [said]) == [said]) is kept
