"""Convex hulls of points, and how far a surface lies below one."""

from __future__ import annotations

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from ...asset import Hull
from ...errors import InvalidAsset
from ...geometry.rows import distinct_rows
from ...geometry.triangles import doubled_normals
from ...mesh import FloatArray, IntArray
from ...runtime.numbers import DECIMALS

#: Bodies thinner than this are planes: qhull and the simulators' cookers lose them. Gaps that are
#: narrower or wider by less are so by rounding [m].
THINNEST_M = 1e-5
#: Places nearer to one another are one [m].
SAME_M = 1e-6


def hull_of(points: FloatArray) -> Hull | None:
    """Return the convex hull of points [m], shape [n, 3]; ``None`` if they are (nearly) coplanar.

    Of the points as they are written, in one order: last digits, which are others on every
    processor, would decide how flat faces are cut into triangles, and all that follows from it.
    """
    points = np.round(points, DECIMALS) + 0.0
    points = points[distinct_rows(points)[0]]
    if len(points) < 4:
        return None
    center = points.mean(axis=0)
    try:
        # Around the origin, so that qhull's absolute tolerances do not depend on where the object
        # stands.
        found = ConvexHull(points - center)
    except (QhullError, ValueError):
        return None
    corners = np.unique(found.simplices)
    faces = np.searchsorted(corners, found.simplices)
    vertices = points[corners]
    normals = doubled_normals(vertices[faces])
    inward = np.einsum("ij,ij->i", normals, found.equations[:, :3]) < 0.0
    faces[inward] = faces[inward][:, ::-1]
    # A body is at least as thick as twice its volume over its surface: mostly that is enough, with
    # room for qhull's rounding.
    if found.volume < THINNEST_M * found.area and thickness(vertices, found.equations) < THINNEST_M:
        return None
    # In one order, each from its smallest index on: the same hull has the same bytes.
    faces = begun_lowest(faces)
    try:
        return Hull(vertices=vertices, faces=faces[np.lexsort(faces.T[::-1])])
    except InvalidAsset:
        return None


def begun_lowest(faces: IntArray) -> IntArray:
    """Return the same faces, each from its smallest index on, shape [m, 3]."""
    first = faces.argmin(axis=1)
    return np.take_along_axis(faces, (first[:, None] + np.arange(3)) % 3, axis=1)


def thickness(vertices: FloatArray, planes: FloatArray) -> float:
    """Return the least width of a convex body over its face normals [m]; ``planes``: [n, 4]."""
    heights = vertices @ planes[:, :3].T
    return float((heights.max(axis=0) - heights.min(axis=0)).min())


def edges_of(hull: Hull) -> IntArray:
    """Return the corners at the ends of each edge of a hull, the lower one first, shape [n, 2]."""
    around = hull.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    return np.asarray(around[around[:, 0] < around[:, 1]])


def depth_below(hull: Hull, points: FloatArray) -> FloatArray:
    """Return how far each point lies below the hull's surface [m], shape [n].

    Negative outside: there the hull is at least as far, see :mod:`.outside`.
    """
    planes = hull.planes
    depth = np.full(len(points), np.inf)
    for start in range(0, len(planes), 256):
        chunk = planes[start : start + 256]
        np.minimum(depth, (chunk[:, 3] - points @ chunk[:, :3].T).min(axis=1), out=depth)
    return depth


def surface_points(vertices: FloatArray, faces: IntArray) -> FloatArray:
    """Return triangles' corners, edge midpoints and centroids, where dents show, shape [n, 3]."""
    corners = vertices[faces]
    middles = (corners + np.roll(corners, 1, axis=1)) / 2.0
    return np.concatenate(
        [vertices[np.unique(faces)], middles.reshape(-1, 3), corners.mean(axis=1)]
    )


def concavity(vertices: FloatArray, faces: IntArray, hull: Hull) -> float:
    """Return the deepest dent of a surface: largest depth of it below its convex hull [m]."""
    return float(depth_below(hull, surface_points(vertices, faces)).max())


def limit_vertices(hull: Hull, limit: int) -> Hull:
    """Return a hull of at most ``limit`` of a hull's corners: it is inside, so clearance stays.

    Each next corner that is taken is the one farthest outside the hull of those before it.
    """
    if len(hull.vertices) <= limit:
        return hull
    points = hull.vertices
    taken = _extreme_corners(points)
    current = hull_of(points[taken])
    while current is not None and len(taken) < limit:
        outside = -depth_below(current, points)
        outside[taken] = -np.inf
        best = int(outside.argmax())
        if outside[best] <= THINNEST_M:
            break
        taken.append(best)
        current = hull_of(points[taken])
    return hull if current is None else current


def _extreme_corners(points: FloatArray) -> list[int]:
    """Return the extremes along principal axes and diagonals: a body's are never coplanar."""
    centered = points - points.mean(axis=0)
    _, _, axes = np.linalg.svd(centered, full_matrices=False)
    signs = np.array(
        [[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1], [1, 1, -1], [1, -1, 1], [-1, 1, 1]],
        dtype=float,
    )
    heights = (centered / np.maximum(np.ptp(centered @ axes.T, axis=0).max(), 1e-12)) @ (
        signs @ axes
    ).T
    return sorted({*heights.argmax(axis=0).tolist(), *heights.argmin(axis=0).tolist()})
