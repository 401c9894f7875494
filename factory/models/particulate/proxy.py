"""A lighter stand-in for a very dense mesh, and the labels carried back to the mesh itself."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...mesh import FloatArray, IntArray
from .surface import Surface, has_three_corners, last_of

CHUNK = 1 << 18
"""Faces labelled at once: bounds memory."""


@dataclass(frozen=True)
class Proxy:
    """A simpler surface, to sample in another's stead.

    Attributes:
        surface: same frame, at most as many faces.
        vertex: for each vertex of the original the proxy's vertex that it became, -1 where that has
            no face left, shape [vertex_count]; ``None`` if the proxy is the original.
    """

    surface: Surface
    vertex: IntArray | None = None


def proxy_of(surface: Surface, most_faces: int) -> Proxy:
    """Return the surface with about ``most_faces`` faces, by quadric edge collapse.

    Collapses run along edges, so no two components become one. What falls into pieces too small to
    collapse keeps more faces.
    """
    if len(surface.faces) <= most_faces:
        return Proxy(surface)
    import fast_simplification

    low = surface.vertices.min(axis=0)
    size = float(np.ptp(surface.vertices, axis=0).max()) or 1.0
    # The library's stopping rule is absolute, so it is given a unit box.
    unit = (surface.vertices - low) / size
    # The library's default aggression of 7 opens thin walls.
    points, fewer, collapses = fast_simplification.simplify(
        unit, surface.faces.astype(np.int32), target_count=most_faces, agg=3, return_collapses=True
    )
    # A pair's second vertex was drawn into its first.
    into = np.arange(len(unit))
    into[collapses[:, 1]] = collapses[:, 0]
    kept = last_of(into)
    corners = kept[surface.faces]
    corners = corners[has_three_corners(corners)]
    used = np.unique(corners)
    same = len(corners) == len(fewer) > 0 and len(used) == len(points)
    if not (same and np.isfinite(points).all()):
        return Proxy(surface)
    vertex = np.searchsorted(used, kept)
    vertex = np.where(used[np.minimum(vertex, len(used) - 1)] == kept, vertex, -1)
    vertices = np.asarray(points, dtype=np.float64) * size + low
    return Proxy(Surface(vertices, np.asarray(fewer, dtype=np.int64)), vertex)


def carried_back(proxy: Proxy, labels: IntArray, faces: IntArray) -> IntArray:
    """Return the original's faces' labels from the proxy's, shape [original_face_count].

    A face takes the label with the largest area around the three proxy vertices that its corners
    became; -1 where
    nothing there has a label. Ties: the lowest label.

    Args:
        proxy: and its map of vertices.
        labels: of its faces, at least -1, shape [proxy_face_count].
        faces: the original's vertex indices, shape [original_face_count, 3].
    """
    if proxy.vertex is None:
        return labels
    # The last row is that of vertices without faces.
    around = np.pad(_area_by_label(proxy.surface, labels), ((0, 1), (0, 0)))
    carried = np.full(len(faces), -1, dtype=np.int64)
    for begin in range(0, len(faces), CHUNK):
        corners = proxy.vertex[faces[begin : begin + CHUNK]]
        weight = around[corners[:, 0]] + around[corners[:, 1]] + around[corners[:, 2]]
        best = weight.argmax(axis=1)
        said = weight[np.arange(len(best)), best] > 0.0
        carried[begin : begin + CHUNK] = np.where(said, best, -1)
    return carried


def _area_by_label(surface: Surface, labels: IntArray) -> FloatArray:
    """Return the area of the faces around each vertex by label, [vertex_count, label_count]."""
    count = int(labels.max(initial=0)) + 1
    said = labels >= 0
    key = surface.faces[said] * count + labels[said][:, None]
    weights = np.repeat(surface.areas[said], 3)
    total = np.bincount(key.ravel(), weights=weights, minlength=len(surface.vertices) * count)
    return np.asarray(total.reshape(len(surface.vertices), count))
