"""Surfaces where the mesh ends: rims, backs and walls of hollows, as triangles."""

from __future__ import annotations

from collections.abc import Sequence

import manifold3d
import numpy as np

from ...geometry.rows import distinct_rows
from ...mesh import BoolArray, FloatArray
from ..decompose.convex import SAME_M
from ..decompose.solids import triangles_of, union
from .box import Box

#: A border this near to a column's side was cut there [m].
AT_SIDE_M = 0.002

#: Shape [n, 3, 3] [m]; in a panel's frame wound as if that were right-handed, so that normals
#: computed there point out.
Triangles = FloatArray


def boundary(triangles: Triangles) -> FloatArray:
    """Return the edges of only one of some triangles, in their direction; shape [n, 2, 3]."""
    _, corner = distinct_rows(np.round(triangles.reshape(-1, 3) / SAME_M).astype(np.int64))
    around = [[0, 1], [1, 2], [2, 0]]
    edges = np.sort(corner.reshape(-1, 3)[:, around].reshape(-1, 2), axis=1)
    ends = triangles[:, around].reshape(-1, 2, 3)
    _, edge = distinct_rows(edges)
    alone = np.bincount(edge)[edge] == 1
    return np.asarray(ends[alone & (edges[:, 0] != edges[:, 1])])


def rim(edges: FloatArray, column: Box, back: float, sides: BoolArray) -> Triangles:
    """Return the strips from the edges of a cut to a plane, facing out of the column.

    Edges, shape [n, 2, 3], the column along whose sides the mesh was cut, and the depth ``back`` of
    the plane are in the panel's frame [m]; of the sides left, right, lower and upper some are
    taken.
    """
    ends = np.stack([column.low[:2], column.high[:2]], axis=-1).ravel()
    off = np.abs(edges[:, :, [0, 0, 1, 1]] - ends)
    at_side = ((off < AT_SIDE_M).all(axis=1) & sides).any(axis=1)
    before = (edges[:, :, 2] < back - SAME_M).any(axis=1)
    start, end = edges[at_side & before].transpose(1, 0, 2)
    far_start = start.copy()
    far_end = end.copy()
    far_start[:, 2] = np.maximum(start[:, 2], back)
    far_end[:, 2] = np.maximum(end[:, 2], back)
    # The frame is left-handed: what continues the skin's winding in space is wound against it here.
    return np.concatenate(
        [np.stack([start, end, far_start], axis=1), np.stack([end, far_end, far_start], axis=1)]
    )


def plate(outline: FloatArray, holes: Sequence[FloatArray], depth: float) -> Triangles:
    """Return a flat face at some depth [m], seen from behind.

    Holes are cut out of its convex outline; both are (right, up) [m], shape [n, 2].
    """
    section = manifold3d.CrossSection([outline])
    for hole in holes:
        section = section - manifold3d.CrossSection([hole])
    polygons = [np.asarray(each) for each in section.to_polygons()]
    if not polygons:
        return np.zeros((0, 3, 3))
    points = np.concatenate(polygons)
    faces = np.asarray(manifold3d.triangulate(polygons))
    flat = np.column_stack([points, np.full(len(points), depth)])
    return np.asarray(flat[faces])


def flipped(triangles: Triangles) -> Triangles:
    """Return the same triangles seen from the other side."""
    return triangles[:, ::-1]


def rectangle(box: Box) -> FloatArray:
    """Return a box's outline (right, up), counter-clockwise, shape [4, 2]."""
    left, bottom = box.low[:2]
    right, top = box.high[:2]
    return np.array([[left, bottom], [right, bottom], [right, top], [left, top]])


def outline_of(points: FloatArray) -> FloatArray:
    """Return the convex outline of points, (right, up), counter-clockwise, shape [n, 2]."""
    section = manifold3d.CrossSection.hull_points(np.asarray(points[:, :2], dtype=np.float64))
    polygons = section.to_polygons()
    return np.asarray(polygons[0]) if polygons else np.zeros((0, 2))


def inside_of(boxes: Sequence[Box], mouth: float) -> Triangles:
    """Return the walls of hollows, seen from within, but for the mouth at one depth [m]."""
    triangles = outside_of(boxes)
    closed = (np.abs(triangles[:, :, 2] - mouth) < SAME_M).all(axis=1)
    return flipped(triangles[~closed])


def outside_of(boxes: Sequence[Box]) -> Triangles:
    """Return the surface of all boxes together, seen from outside."""
    solids = [
        manifold3d.Manifold.cube(box.size.tolist()).translate(box.low.tolist()) for box in boxes
    ]
    points, faces = triangles_of(union(solids))
    return np.asarray(points[faces])
