"""The gate to native code: triangles of any kind become solids, cavities and sheets.

Nothing native sees anything else.
"""

import numpy as np
import numpy.typing as npt
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from manifold3d import Manifold
from plain_solids import sized_box as box

from asset_factory.factory.manufacture.decompose.openings import capped
from asset_factory.factory.manufacture.decompose.simplify import simplified
from asset_factory.factory.manufacture.decompose.solids import (
    closes,
    contains,
    gate,
    manifold_of,
    triangles_of,
)

Triangles = tuple[npt.NDArray[np.float64], npt.NDArray[np.int64]]


def together(*meshes):
    vertices = [own for own, _ in meshes]
    offset = np.cumsum([0, *map(len, vertices[:-1])])
    faces = [own + start for (_, own), start in zip(meshes, offset, strict=True)]
    return np.concatenate(vertices), np.concatenate(faces)


def welded(mesh):
    vertices, index = np.unique(np.round(mesh[0], 9), axis=0, return_inverse=True)
    return vertices, index.reshape(-1)[mesh[1]]


def volumes(mesh):
    return sorted(round(solid.volume(), 9) for solid in gate(*mesh).solids)


def test_a_pane_at_the_corners_of_its_frame_is_a_sheet():
    # Beside a box, not in it, and hung from two of its corners.
    vertices, faces = box((1, 1, 1))
    hung = np.flatnonzero((vertices[:, 0] > 0) & (vertices[:, 1] > 0))
    vertices = np.concatenate([vertices, [[2.0, 0.5, 0.0]]])
    pane = np.array([[*hung, 8], [*hung[::-1], 8]])
    gated = gate(vertices, np.concatenate([faces, pane]))
    assert [solid.volume() for solid in gated.solids] == pytest.approx([1.0])
    assert [len(sheet.faces) for sheet in gated.sheets] == [1]


def test_boxes_that_share_welded_faces_edges_or_corners_come_apart():
    for at in ((1, 0, 0), (1, 1, 0), (1, 1, 1)):
        assert volumes(welded(together(box((1, 1, 1)), box((1, 1, 1), at)))) == [1.0, 1.0]


def test_a_grain_at_a_bodys_corner_is_nothing():
    vertices, faces = box((1, 1, 1))
    grain = 5e-5 * (vertices - vertices.min(axis=0)) + vertices.max(axis=0)
    assert volumes(welded(together((vertices, faces), (grain, faces)))) == [1.0]


def test_a_body_that_stands_out_of_another_does_not_lie_in_it_however_little_does():
    outer = Manifold.cube([1.0, 1.0, 1.0], True)
    inner = Manifold.cube([0.5, 0.5, 0.5], True)
    assert contains(outer, inner)
    assert not contains(outer, inner + Manifold.cube([0.01, 0.01, 1.2], True))


def test_an_open_box_is_a_sheet_wound_one_way():
    vertices, faces = box((1, 1, 1))
    faces = faces[faces.min(axis=1) >= 0][2:].copy()
    faces[::2] = faces[::2, ::-1]
    gated = gate(vertices, faces)
    assert not gated.solids
    assert len(gated.sheets) == 1
    corners = gated.sheets[0].vertices[gated.sheets[0].faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    outward = np.einsum("ij,ij->i", across, corners[:, 0])
    assert abs(np.sign(outward).sum()) == len(outward)


def test_an_open_surface_is_refused_before_anything_native_sees_it():
    # Five faces of a box corner: on odd numbers of faces like these manifold3d 3.5 dies of a
    # segmentation fault.
    faces = np.array([[35, 33, 31], [33, 11, 9], [31, 9, 7], [33, 35, 11], [31, 33, 9]])
    assert not closes(faces)
    assert manifold_of(np.random.default_rng(0).normal(size=(36, 3)), faces) is None


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(3, 9), st.integers(1, 24))
def test_any_soup_is_gated_without_a_crash_and_only_closed_positive_solids_come_out(
    seed, vertex_count, face_count
):
    random = np.random.default_rng(seed)
    faces = random.integers(0, vertex_count, size=(face_count, 3))
    faces = np.concatenate([faces, faces[random.random(face_count) < 0.5][:, ::-1]])
    faces = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]
    gated = gate(random.normal(size=(vertex_count, 3)), faces)
    for solid in (*gated.solids, *gated.cavities):
        assert solid.volume() > 0.0
        assert closes(triangles_of(solid)[1])


def test_a_pipe_with_hidden_open_ends_is_closed_and_a_box_without_a_lid_is_not():
    pipe = trimesh.creation.cylinder(radius=0.01, height=0.5, sections=24)
    flat = np.abs(pipe.face_normals[:, 2]) < 0.5
    solid = capped(gate(np.array(pipe.vertices), np.array(pipe.faces)[flat]).sheets[0])
    assert solid.volume() == pytest.approx(pipe.volume, rel=1e-6)
    vertices, faces = box((1, 1, 1))
    lidless = faces[~(vertices[faces][:, :, 2] > 0).all(axis=1)]
    assert capped(gate(vertices, lidless).sheets[0]) is None


def test_simplifying_keeps_a_closed_solid_of_nearly_the_same_volume():
    sphere = trimesh.creation.icosphere(subdivisions=4, radius=0.2)
    solid = manifold_of(np.array(sphere.vertices), np.array(sphere.faces))
    light = simplified(solid, 400, 0.0005)
    assert light.num_tri() <= 400
    assert light.volume() == pytest.approx(solid.volume(), rel=0.03)
