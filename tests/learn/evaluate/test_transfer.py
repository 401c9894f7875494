"""The truth goes with the triangles, however an articulator cuts them."""

import numpy as np
from cupboards import cupboard, hinge

from asset_factory.factory.geometry.posing import face_parts
from asset_factory.factory.geometry.triangles import face_areas
from asset_factory.factory.mesh import Mesh
from asset_factory.learn.evaluate.physical import physical
from asset_factory.learn.evaluate.transfer import on_mesh, sources


def halved(mesh, chosen):
    """With the chosen triangles cut in two from a corner, and all of them shuffled."""
    a, b, c = mesh.faces[chosen].T
    new = len(mesh.vertices) + np.arange(len(chosen))
    middles = (mesh.vertices[b] + mesh.vertices[c]) / 2.0
    kept = np.delete(mesh.faces, chosen, axis=0)
    faces = np.concatenate([kept, np.stack([a, b, new], 1), np.stack([a, new, c], 1)])
    order = np.random.default_rng(0).permutation(len(faces))
    return Mesh.from_triangles(np.concatenate([mesh.vertices, middles]), faces[order])


def test_every_cut_triangle_knows_where_it_comes_from_and_is_scored_as_that():
    truth = cupboard(hinge())
    cut = halved(truth.mesh, np.arange(0, len(truth.mesh.faces), 3))
    source = sources(truth.mesh, cut)
    area = np.bincount(source, weights=face_areas(cut), minlength=len(truth.mesh.faces))
    assert np.allclose(area, face_areas(truth.mesh))
    answer = on_mesh(truth, cut)
    assert (face_parts(answer) == face_parts(truth)[source]).all()
    assert physical(answer, answer).values["part_miou"] == 1.0
    assert on_mesh(truth, truth.mesh) is truth
