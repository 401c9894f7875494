"""One-piece meshes are read from their sides; what is unsure stays fixed; others are not asked."""

from dataclasses import replace

import numpy as np
from one_piece import bin_with_lid, drawers, plain_box

from asset_factory.factory.articulate.auto.one_piece import MeshOrigin, least_of, seam_hypotheses
from asset_factory.factory.articulate.auto.trust import load_trust
from asset_factory.factory.articulate.seams import SeamsArticulator
from asset_factory.factory.mesh import Mesh, concatenate
from asset_factory.learn.objects import make_object


def crumb(mesh, size):
    """The same with a small tetrahedron beside it."""
    corners = np.vstack([np.zeros(3), size * np.eye(3)]) + mesh.bounds[1]
    sides = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    return concatenate([mesh, Mesh.from_triangles(corners, sides)])


def bumpy(mesh):
    """The same with every vertex a little off."""
    rng = np.random.default_rng(0)
    return replace(mesh, vertices=mesh.vertices + rng.normal(0.0, 1e-3, mesh.vertices.shape))


def test_one_surface_with_crumbs_is_one_piece_and_an_assembly_is_not():
    whole = plain_box()
    assert MeshOrigin.of(whole).one_piece
    assert MeshOrigin.of(crumb(whole, 0.05)).one_piece
    assert not MeshOrigin.of(crumb(whole, 0.8)).one_piece
    assert not MeshOrigin.of(make_object("cabinet", 0).mesh).one_piece


def test_only_what_bends_a_little_everywhere_is_a_skin():
    assert not MeshOrigin.of(drawers()).is_generated
    assert MeshOrigin.of(bumpy(drawers())).is_generated
    assert not MeshOrigin.of(bumpy(make_object("cabinet", 0).mesh)).is_generated


def test_auto_reads_a_skin_by_its_seams():
    found = seam_hypotheses(drawers(), least_of(load_trust(), None), "auto")[0].articulation
    assert [joint.kind for joint in found.joints] == ["prismatic"] * 3
    assert found.articulator == "auto"


def test_what_is_unsure_stays_with_the_base(monkeypatch):
    mesh = drawers()
    seen = SeamsArticulator().hypotheses(mesh)
    monkeypatch.setattr(SeamsArticulator, "hypotheses", lambda self, mesh: seen)
    every = seam_hypotheses(mesh, 0.0, "auto")[0].articulation
    confidences = sorted(part.confidence or 0.0 for part in every.parts[1:])
    some = seam_hypotheses(mesh, confidences[1] - 1e-12, "auto")[0].articulation
    assert 1 < len(some.parts) <= len(every.parts)
    assert sum(len(part.faces) for part in some.parts) == len(some.mesh.faces)
    (none,) = seam_hypotheses(mesh, 0.999, "auto")
    assert not none.articulation.movable_joints


def test_other_hypotheses_differ_from_the_likeliest():
    found = seam_hypotheses(bin_with_lid(), 0.0, "auto")
    told = [
        [(joint.kind, joint.axis.tolist()) for joint in each.articulation.joints] for each in found
    ]
    assert len(told) > 1
    assert all(told.count(each) == 1 for each in told)
