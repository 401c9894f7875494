"""Which faces hang together: components robust to double-sided faces and touching boxes."""

from __future__ import annotations

import numpy as np

from ..mesh import IntArray, Mesh
from .edges import label_linked, shared_edges
from .rows import distinct_rows, number_by_appearance, weld_points

WELD_SHARE = 1e-6
"""Positions closer than this share of the mesh's diagonal are one vertex."""


def connected_components(mesh: Mesh) -> IntArray:
    """Return the component number of every face, shape [face_count].

    Vertices are welded by position, faces on the same three vertices count once, and two faces are
    neighbours over an edge that exactly two faces share. So a double-sided sheet is one component
    (without the second rule each of its triangles would be one), and boxes that only touch along an
    edge stay apart.

    Numbers are 0, 1, ... in the order of each component's first face. A face without area belongs
    to the lowest-numbered component that uses one of its vertices, if any.
    """
    step = max(mesh.diagonal * WELD_SHARE, 1e-12)
    faces = weld_points(mesh.vertices, mesh.bounds[0], step)[1][mesh.faces]
    if not len(faces):
        return np.zeros(0, dtype=np.int64)
    corners = np.sort(faces, axis=1)
    first, twin = distinct_rows(corners)
    unique = corners[first]
    proper = (unique[:, 0] != unique[:, 1]) & (unique[:, 1] != unique[:, 2])
    rows = np.flatnonzero(proper)
    # Faces without area stay alone.
    labels = label_linked(len(unique), rows[shared_edges(unique[rows]).faces])[twin]
    labels = _adopt_slivers(labels, faces, proper[twin])
    return number_by_appearance(*distinct_rows(labels[:, None]))[1]


def _adopt_slivers(labels: IntArray, faces: IntArray, proper: IntArray) -> IntArray:
    """Give faces without area to a component at one of their vertices."""
    if proper.all():
        return labels
    nobody = np.iinfo(np.int64).max
    of_vertex = np.full(int(faces.max()) + 1, nobody, dtype=np.int64)
    np.minimum.at(of_vertex, faces[proper].reshape(-1), np.repeat(labels[proper], 3))
    adopted = labels.copy()
    found = of_vertex[faces[~proper]].min(axis=1)
    adopted[~proper] = np.where(found == nobody, labels[~proper], found)
    return adopted
