"""Cuts along planes: same surface, closed as before, appearance kept."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from one_piece import fridge

from asset_factory.factory.articulate.seams.cutting import Region, cut_along, inside
from asset_factory.factory.geometry.triangles import face_areas


def box_region(low, high):
    normals = np.concatenate([np.eye(3), -np.eye(3)])
    return Region(normals, np.concatenate([high, -np.array(low)]))


def open_edges(mesh):
    """Edges that are not there exactly once in each direction."""
    edges = mesh.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    forward = {(int(a), int(b)) for a, b in edges}
    return sum((b, a) not in forward for a, b in forward) + len(edges) - len(forward)


def painted(mesh):
    """The mesh with texture coordinates and normals that are linear in the position."""
    corners = mesh.vertices[mesh.faces]
    normals = np.broadcast_to(np.array([0.0, 0.6, 0.8]), corners.shape)
    return replace(mesh, corner_uv=corners[:, :, [0, 2]], corner_normals=normals)


@settings(max_examples=15, deadline=None)
@given(
    low=st.lists(st.floats(-0.1, 0.5), min_size=3, max_size=3),
    size=st.lists(st.floats(0.02, 0.6), min_size=3, max_size=3),
)
def test_a_cut_keeps_the_surface(low, size):
    mesh = painted(fridge())
    region = box_region(low, [a + b for a, b in zip(low, size, strict=True)])
    cut = cut_along(mesh, [region])
    assert open_edges(cut.mesh) == open_edges(mesh) == 0
    assert face_areas(cut.mesh).sum() == pytest.approx(face_areas(mesh).sum(), rel=1e-9)
    corners = cut.mesh.vertices[cut.mesh.faces]
    assert cut.mesh.corner_uv is not None
    assert cut.mesh.corner_normals is not None
    assert np.allclose(cut.mesh.corner_uv, corners[:, :, [0, 2]], atol=1e-9)
    assert np.allclose(cut.mesh.corner_normals, [0.0, 0.6, 0.8])
    assert (mesh.face_material[cut.source] == cut.mesh.face_material).all()


def test_no_triangle_is_on_both_sides():
    mesh = fridge()
    region = box_region([0.1, -1.0, 0.2], [0.45, 0.1, 1.3])
    cut = cut_along(mesh, [region])
    within = inside(cut.mesh, region)
    corners = cut.mesh.vertices[cut.mesh.faces[within]]
    assert within.any()
    slack = 2e-5 * mesh.diagonal
    assert (corners >= np.array([0.1, -1.0, 0.2]) - slack).all()
    assert (corners <= np.array([0.45, 0.1, 1.3]) + slack).all()
    outside = cut.mesh.vertices[cut.mesh.faces[~within]].mean(axis=1)
    center = np.array([0.275, -0.45, 0.75])
    half = np.array([0.175, 0.55, 0.55])
    assert not (np.abs(outside - center) < half - slack).all(axis=1).any()


def test_what_needs_no_cut_is_not_cut():
    mesh = fridge()
    everything = box_region([-1.0, -1.0, -1.0], [2.0, 2.0, 2.0])
    assert cut_along(mesh, [everything]).mesh is mesh
