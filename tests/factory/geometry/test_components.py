"""Connected components: double-sided sheets hold together, boxes that touch stay apart."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from plain_solids import box_between as box

from asset_factory.factory.geometry.components import connected_components
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
