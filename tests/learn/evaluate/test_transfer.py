"""The truth goes with the triangles, however an articulator cuts them."""

import numpy as np
import trimesh
from cupboards import cupboard, hinge

from asset_factory.factory.geometry.posing import face_parts
from asset_factory.factory.geometry.triangles import face_areas
from asset_factory.factory.mesh import Mesh
from asset_factory.learn.evaluate.physical import physical
from asset_factory.learn.evaluate.transfer import on_mesh, sources


def quartered(mesh, chosen):
    """With the chosen triangles cut in four, and all of them shuffled."""
    vertices, faces = trimesh.remesh.subdivide(mesh.vertices, mesh.faces, face_index=chosen)
    return Mesh.from_triangles(vertices, np.random.default_rng(0).permutation(faces))


def test_every_cut_triangle_knows_where_it_comes_from_and_is_scored_as_that():
    truth = cupboard(hinge())
    cut = quartered(truth.mesh, np.arange(0, len(truth.mesh.faces), 3))
    source = sources(truth.mesh, cut)
    area = np.bincount(source, weights=face_areas(cut), minlength=len(truth.mesh.faces))
    assert np.allclose(area, face_areas(truth.mesh))
    answer = on_mesh(truth, cut)
    assert (face_parts(answer) == face_parts(truth)[source]).all()
    assert physical(answer, answer).values["part_miou"] == 1.0
    assert on_mesh(truth, truth.mesh) is truth
