"""Which faces hang together: by shared edges, by links, as equal rows."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from plain_solids import box_between as box

from asset_factory.factory.geometry.components import connected_components
from asset_factory.factory.geometry.edges import label_linked, shared_edges
from asset_factory.factory.geometry.rows import distinct_rows
from asset_factory.factory.mesh import Mesh, concatenate

BOX = box((0, 0, 0), (1, 1, 1))
SEAMS = Mesh.from_triangles(BOX.vertices[BOX.faces].reshape(-1, 3), np.arange(36).reshape(-1, 3))
SHEET = Mesh.from_triangles(
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3], [2, 1, 0], [3, 2, 0]]
)


@pytest.mark.parametrize(
    ("mesh", "labels"),
    [
        (BOX, [0] * 12),
        (Mesh.from_triangles(np.zeros((0, 3)), np.zeros((0, 3))), []),
        (SEAMS, [0] * 12),
        (SHEET, [0] * 4),
        (concatenate([BOX, box((1, 1, 0), (2, 2, 1))]), [0] * 12 + [1] * 12),
        (Mesh.from_triangles(BOX.vertices, np.vstack([BOX.faces, [[0, 0, 1]]])), [0] * 13),
    ],
    ids=["box", "nothing", "seams", "double-sided", "sharing an edge", "a face without area"],
)
def test_faces_are_labelled_by_what_they_hang_together_with(mesh, labels):
    assert connected_components(mesh).tolist() == labels


@settings(max_examples=25)
@given(st.permutations(range(36)))
def test_components_do_not_depend_on_the_order_of_faces(order):
    three = concatenate([box((2.0 * k, 0, 0), (2.0 * k + 1, 1, 1)) for k in range(3)])
    labels = connected_components(Mesh.from_triangles(three.vertices, three.faces[order]))
    truth = np.array(order) // 12
    assert all(len(np.unique(truth[labels == k])) == 1 for k in range(3))
    assert labels.max() == 2
    first = [int(np.flatnonzero(labels == k)[0]) for k in range(3)]
    assert first == sorted(first)


#: A tetrahedron wound outward.
CLOSED = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])


def test_every_edge_of_a_closed_surface_is_shared_by_two_faces_wound_alike():
    shared = shared_edges(CLOSED)
    assert shared.vertices.tolist() == [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]]
    assert (shared.forward.sum(axis=1) == 1).all()
    for edge, faces in zip(shared.vertices, shared.faces, strict=True):
        assert all(np.isin(edge, CLOSED[face]).all() for face in faces)
    # A face turned round is not wound as its neighbours.
    shared = shared_edges(np.vstack([CLOSED[:1, ::-1], CLOSED[1:]]))
    alike = shared.forward[:, 0] != shared.forward[:, 1]
    assert (alike == ~(shared.faces == 0).any(axis=1)).all()


def test_edges_of_one_or_three_faces_are_not_shared():
    assert not len(shared_edges(np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4]])).faces)
    assert not len(shared_edges(np.zeros((0, 3), dtype=np.int64)).faces)


def test_what_is_linked_is_one_group():
    assert label_linked(5, np.array([[3, 1], [4, 2]])).tolist() == [0, 1, 2, 1, 2]
    assert label_linked(2, np.zeros((0, 2), dtype=np.int64)).tolist() == [0, 1]


SHAPES = st.tuples(st.integers(0, 30), st.integers(1, 4))
TYPES = st.sampled_from([np.int64, np.float64])
TABLES = hnp.arrays(TYPES, SHAPES, elements=st.integers(-2, 2))


@given(TABLES)
def test_distinct_rows_are_those_that_numpy_finds(rows):
    first, which = distinct_rows(rows)
    _, index, inverse = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    assert first.tolist() == index.tolist()
    assert which.tolist() == inverse.reshape(-1).tolist()
    assert (rows[first][which] == rows).all()
