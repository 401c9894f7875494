"""Connected components: double-sided sheets hold together, boxes that touch stay apart."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from plain_solids import box_between as box

from asset_factory.factory.geometry.components import connected_components
from asset_factory.factory.mesh import Mesh, concatenate


def test_a_box_is_one_component():
    assert connected_components(box((0, 0, 0), (1, 1, 1))).tolist() == [0] * 12


def test_a_mesh_without_faces_has_no_labels():
    nothing = Mesh.from_triangles(np.zeros((0, 3)), np.zeros((0, 3)))
    assert connected_components(nothing).shape == (0,)


def test_vertices_repeated_at_a_seam_do_not_split_a_box():
    welded = box((0, 0, 0), (1, 1, 1))
    corners = welded.vertices[welded.faces].reshape(-1, 3)
    loose = Mesh.from_triangles(corners, np.arange(36).reshape(-1, 3))
    assert connected_components(loose).tolist() == [0] * 12


def test_a_double_sided_sheet_is_one_component():
    corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    sheet = Mesh.from_triangles(corners, [[0, 1, 2], [0, 2, 3], [2, 1, 0], [3, 2, 0]])
    assert connected_components(sheet).tolist() == [0, 0, 0, 0]


def test_boxes_that_share_only_an_edge_stay_apart():
    pair = concatenate([box((0, 0, 0), (1, 1, 1)), box((1, 1, 0), (2, 2, 1))])
    assert connected_components(pair).tolist() == [0] * 12 + [1] * 12


def test_a_face_without_area_joins_the_component_at_its_vertex():
    solid = box((0, 0, 0), (1, 1, 1))
    mesh = Mesh.from_triangles(solid.vertices, np.vstack([solid.faces, [[0, 0, 1]]]))
    assert connected_components(mesh).tolist() == [0] * 13


@settings(max_examples=25, deadline=None)
@given(st.permutations(range(36)), st.floats(-0.2, 0.2))
def test_components_do_not_depend_on_the_order_of_faces(order, angle):
    three = concatenate([box((2.0 * k, 0, 0), (2.0 * k + 1, 1, 1)) for k in range(3)])
    shuffled = Mesh.from_triangles(three.vertices, three.faces[order])
    labels = connected_components(shuffled)
    truth = np.array(order) // 12
    assert all(len(np.unique(truth[labels == k])) == 1 for k in range(3))
    assert labels.max() == 2
    first = [int(np.flatnonzero(labels == k)[0]) for k in range(3)]
    assert first == sorted(first)
