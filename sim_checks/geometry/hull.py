"""Convex polyhedra with what exact overlap tests need: merged face normals and sharp edges."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from scipy.spatial import ConvexHull, QhullError, cKDTree

from ..description import FloatArray, IntArray

#: Two facets belong to one face when their unit normals differ by less than this.
SAME_NORMAL = 1e-7
#: A hull thinner than this share of its own size has no inside.
FLAT = 1e-6


#: No hull is smaller [m]: what is, was scaled away.
SMALLEST = 1e-9
#: A hull of more corners is replaced by that of its farthest corners around its middle: what it
#: costs grows with their square, engines take 64 to 256, and a ball loses less than 0.5 % of its
#: radius.
MOST_CORNERS = 4000
#: Cells along each edge of a cube around such a hull; one corner is kept in each.
CELLS = 24
#: Products of corners and faces taken at a time, which bounds memory.
BLOCK = 4_000_000
#: A foot this far beyond a face, as a share of the size of the numbers, is on it but for rounding.
ROUNDING = 1e-12


class FlatHull(ValueError):
    """The points span no volume."""


@dataclass(frozen=True)
class CollisionHull:
    """A convex polyhedron.

    Attributes:
        vertices: corners [m], shape [vertex_count, 3].
        triangles: outward, shape [triangle_count, 3].
        normals: outward unit normals of the faces, coplanar triangles merged, shape [face_count,
            3].
        offsets: ``normals @ x <= offsets`` inside [m], shape [face_count].
        edges: vertex pairs between faces that are not coplanar, shape [edge_count, 2].
        sides: normals of the two faces at each edge, shape [edge_count, 2, 3].
        volume: [m3].
        corners: how many the points' whole hull has; more than ``vertices`` where it was thinned.
    """

    vertices: FloatArray
    triangles: IntArray
    normals: FloatArray
    offsets: FloatArray
    edges: IntArray
    sides: FloatArray
    volume: float
    corners: int

    @property
    def bounds(self) -> FloatArray:
        """Return the lowest and highest corner of the axis-aligned box, shape [2, 3]."""
        return np.array([self.vertices.min(axis=0), self.vertices.max(axis=0)])

    def moved(self, pose: FloatArray) -> CollisionHull:
        """Return the same hull placed by a rigid motion, shape [4, 4]."""
        rotation = pose[:3, :3]
        shift = pose[:3, 3]
        normals = self.normals @ rotation.T
        return replace(
            self,
            vertices=self.vertices @ rotation.T + shift,
            normals=normals,
            offsets=self.offsets + normals @ shift,
            sides=self.sides @ rotation.T,
        )


def convex_hull(points: FloatArray) -> CollisionHull:
    """Return the convex hull of points [m], shape [point_count, 3]; thinned if it has many corners.

    A thinned hull is a little smaller.

    Raises:
        FlatHull: fewer than four points, or all in one plane.
    """
    if len(points) <= MOST_CORNERS:
        return _convex_hull(points)
    return _large_hull(np.ascontiguousarray(points, dtype=np.float64).tobytes())


def find_hull(points: FloatArray) -> CollisionHull | None:
    """Return what :func:`convex_hull` does; ``None`` where points span no volume."""
    with suppress(FlatHull):
        return convex_hull(points)
    return None


@lru_cache(maxsize=4)
def _large_hull(data: bytes) -> CollisionHull:
    """Return every check asks for the same few large ones, which take seconds."""
    return _convex_hull(np.frombuffer(data).reshape(-1, 3))


def _convex_hull(points: FloatArray) -> CollisionHull:
    if len(points) < 4:
        raise FlatHull(f"{len(points)} points, want at least 4")
    center = (points.min(axis=0) + points.max(axis=0)) / 2.0
    size = float(np.ptp(points, axis=0).max())
    if not SMALLEST <= size < np.inf:
        raise FlatHull(f"{len(points)} points {size:g} m across span no volume")
    spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    if not spread[2] > FLAT * spread[0]:
        raise FlatHull(f"{len(points)} points lie in one plane")
    try:
        # Centred, so that far from the origin qhull keeps its digits.
        hull = ConvexHull(points - center)
        corners = len(hull.vertices)
        if corners > MOST_CORNERS:
            hull = ConvexHull(_thinned(hull.points[hull.vertices]))
    except QhullError as error:
        raise FlatHull(f"{len(points)} points span no volume") from error
    return _assemble(hull, center, corners)


def _thinned(points: FloatArray) -> FloatArray:
    """Keep the farthest point in each cell of a cube's sides around the origin, [fewer, 3]."""
    # What is long or flat is looked at as if it were round.
    around = points / np.abs(points).max(axis=0)
    longest = np.argmax(np.abs(around), axis=1)
    rows = np.arange(len(points))
    on_cube = around / np.abs(around[rows, longest])[:, None]
    # Equal angles, not equal lengths, make cells of about one size.
    angles = (np.arctan(on_cube) / (np.pi / 4.0) + 1.0) / 2.0
    cells = np.clip((angles * CELLS).astype(np.int64), 0, CELLS - 1)
    # Along the longest axis, a point is in the first or the last cell: the side of the cube.
    keys = ((longest * CELLS + cells[:, 0]) * CELLS + cells[:, 1]) * CELLS + cells[:, 2]
    order = np.lexsort((-np.linalg.norm(around, axis=1), keys))
    kept = order[np.flatnonzero(np.diff(keys[order], prepend=-1))]
    # The box around everything stays as it is.
    ends = np.concatenate([points.argmin(axis=0), points.argmax(axis=0)])
    thinned: FloatArray = points[np.unique(np.concatenate([kept, ends]))]
    return thinned


def _assemble(hull: ConvexHull, center: FloatArray, corners_before: int) -> CollisionHull:
    corners = hull.vertices
    renumber = np.full(len(hull.points), -1, dtype=np.int64)
    renumber[corners] = np.arange(len(corners))
    vertices = hull.points[corners]
    triangles = renumber[hull.simplices]
    equations = hull.equations
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    turned = np.einsum("ij,ij->i", np.cross(b - a, c - a), equations[:, :3]) < 0.0
    triangles[turned] = triangles[turned][:, [0, 2, 1]]
    # A facet k of scipy's hull lies opposite its k-th corner.
    facet, slot = np.nonzero(np.arange(len(triangles))[:, None] < hull.neighbors)
    other = hull.neighbors[facet, slot]
    sharp = np.linalg.norm(equations[facet, :3] - equations[other, :3], axis=1) > SAME_NORMAL
    facet, slot, other = (rows[sharp] for rows in (facet, slot, other))
    edges = renumber[hull.simplices[facet[:, None], (slot[:, None] + [1, 2]) % 3]]
    sides = np.stack([equations[facet, :3], equations[other, :3]], axis=1)
    _, first = np.unique(np.round(equations[:, :3] / SAME_NORMAL), axis=0, return_index=True)
    normals = equations[np.sort(first), :3]
    offsets = farthest_along(vertices, normals) + normals @ center
    faces = (triangles, normals, offsets, edges, sides)
    return CollisionHull(vertices + center, *faces, float(hull.volume), corners_before)


def farthest_along(points: FloatArray, directions: FloatArray) -> FloatArray:
    """Return the support of points [m], [point_count, 3], along each direction."""
    rows = max(1, BLOCK // len(points))
    blocks = [directions[start : start + rows] for start in range(0, len(directions), rows)]
    return np.concatenate([(points @ block.T).max(axis=0) for block in blocks])


def distance_outside(points: FloatArray, hulls: Sequence[CollisionHull]) -> FloatArray:
    """Return how far points lie outside all of some hulls [m], shape [point_count]; 0 within one.

    A hull lies at least as far off as the farthest of its face planes, and no hull is farther off
    than the nearest corner; only hulls between the two are measured.

    Args:
        points: [m], shape [point_count, 3].
        hulls: at least one, in the same frame.
    """
    least = np.array([np.maximum(0.0, _beyond(points, hull).max(axis=1)) for hull in hulls])
    corners = np.concatenate([hull.vertices for hull in hulls])
    distance = np.where(least.min(axis=0) > 0.0, cKDTree(corners).query(points)[0], 0.0)
    for number, hull in enumerate(hulls):
        asked = least[number] < distance
        distance[asked] = np.minimum(distance[asked], _distances(points[asked], hull))
    return distance


def _distances(points: FloatArray, hull: CollisionHull) -> FloatArray:
    """Return the distances of points outside a hull [m], shape [point_count].

    The nearest point of a hull lies within a face or on an edge. Within a face it is the foot on
    the farthest face plane, as no plane is farther off than the hull.
    """
    beyond = _beyond(points, hull)
    farthest = beyond.argmax(axis=1)
    distances: FloatArray = beyond.max(axis=1)
    feet = points - distances[:, None] * hull.normals[farthest]
    slack = ROUNDING * max(1e-3, float(np.abs(points).max(initial=0.0)))
    on_edge = _beyond(feet, hull).max(axis=1) > slack
    distances[on_edge] = _edge_distances(points[on_edge], hull)
    return distances


def _beyond(points: FloatArray, hull: CollisionHull) -> FloatArray:
    """Return how far points lie beyond each face plane [m], shape [point_count, face_count]."""
    return points @ hull.normals.T - hull.offsets


def _edge_distances(points: FloatArray, hull: CollisionHull) -> FloatArray:
    """Return the distances of points to the nearest edge of a hull [m], shape [point_count]."""
    middle = hull.vertices.mean(axis=0)
    starts, ends = (hull.vertices[hull.edges[:, side]] - middle for side in (0, 1))
    along = ends - starts
    squares = np.einsum("ij,ij->i", along, along)
    points = points - middle
    # |p - a|2 without |p|2, which is the same for all edges.
    offset = np.einsum("ij,ij->i", starts, starts) - 2.0 * points @ starts.T
    reach = points @ along.T - np.einsum("ij,ij->i", starts, along)
    share = np.clip(reach / squares, 0.0, 1.0)
    edge = (offset + share * (share * squares - 2.0 * reach)).argmin(axis=1)
    # Small distances drown in the rounding of large squares, so the nearest is measured again.
    share = share[np.arange(len(points)), edge]
    feet = starts[edge] + share[:, None] * along[edge]
    distances: FloatArray = np.linalg.norm(points - feet, axis=1)
    return distances
