"""Edges that two faces share, and groups of what is linked."""

import numpy as np

from asset_factory.factory.geometry.edges import label_linked, shared_edges

#: A tetrahedron wound outward.
CLOSED = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])


def test_every_edge_of_a_closed_surface_is_shared_by_two_faces_wound_alike():
    shared = shared_edges(CLOSED)
    assert shared.vertices.tolist() == [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]]
    assert shared.alike.all()
    for edge, faces in zip(shared.vertices, shared.faces, strict=True):
        assert all(np.isin(edge, CLOSED[face]).all() for face in faces)
    # A face turned round is not wound as its neighbours.
    shared = shared_edges(np.vstack([CLOSED[:1, ::-1], CLOSED[1:]]))
    assert (shared.alike == ~(shared.faces == 0).any(axis=1)).all()


def test_edges_of_one_or_three_faces_are_not_shared():
    fan = np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4]])
    assert not len(shared_edges(fan).faces)
    assert not len(shared_edges(np.zeros((0, 3), dtype=np.int64)).faces)


def test_what_is_linked_is_one_group():
    assert label_linked(5, np.array([[3, 1], [4, 2]])).tolist() == [0, 1, 2, 1, 2]
    assert label_linked(2, np.zeros((0, 2), dtype=np.int64)).tolist() == [0, 1]
