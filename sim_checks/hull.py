"""Convex polyhedra with what exact overlap tests need: merged face normals and sharp edges."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from .description import FloatArray, IntArray

#: Two facets belong to one face when their unit normals differ by less than this.
SAME_NORMAL = 1e-7
#: A hull thinner than this share of its own size has no inside.
FLAT = 1e-6


class FlatHull(ValueError):
    """The points span no volume."""


@dataclass(frozen=True)
class Hull:
    """A convex polyhedron.

    Attributes:
        vertices: corners [m], shape [vertex_count, 3].
        triangles: outward, shape [triangle_count, 3].
        normals: outward unit normals of the faces, coplanar triangles merged, shape [face_count, 3].
        offsets: ``normals @ x <= offsets`` inside [m], shape [face_count].
        edges: vertex pairs between faces that are not coplanar, shape [edge_count, 2].
        sides: normals of the two faces at each edge, shape [edge_count, 2, 3].
        volume: [m3].
    """

    vertices: FloatArray
    triangles: IntArray
    normals: FloatArray
    offsets: FloatArray
    edges: IntArray
    sides: FloatArray
    volume: float

    @property
    def bounds(self) -> FloatArray:
        """Lowest and highest corner of the axis-aligned box, shape [2, 3]."""
        return np.array([self.vertices.min(axis=0), self.vertices.max(axis=0)])

    def moved(self, pose: FloatArray) -> Hull:
        """The same hull placed by a rigid motion, shape [4, 4]."""
        rotation, shift = pose[:3, :3], pose[:3, 3]
        normals = self.normals @ rotation.T
        return replace(
            self,
            vertices=self.vertices @ rotation.T + shift,
            normals=normals,
            offsets=self.offsets + normals @ shift,
            sides=self.sides @ rotation.T,
        )


def convex_hull(points: FloatArray) -> Hull:
    """The convex hull of points [m], shape [point_count, 3].

    Raises:
        FlatHull: fewer than four points, or all in one plane.
    """
    if len(points) < 4:
        raise FlatHull(f"{len(points)} points, want at least 4")
    center = (points.min(axis=0) + points.max(axis=0)) / 2.0
    size = float(np.ptp(points, axis=0).max())
    spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    if not (np.isfinite(size) and spread[2] > FLAT * spread[0]):
        raise FlatHull(f"{len(points)} points lie in one plane")
    try:
        # Centred, so that far from the origin qhull keeps its digits.
        hull = ConvexHull(points - center)
    except QhullError as error:
        raise FlatHull(f"{len(points)} points span no volume") from error
    return _assemble(hull, center)


def _assemble(hull: ConvexHull, center: FloatArray) -> Hull:
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
    facet, slot, other = facet[sharp], slot[sharp], other[sharp]
    edges = renumber[hull.simplices[facet[:, None], (slot[:, None] + [1, 2]) % 3]]
    sides = np.stack([equations[facet, :3], equations[other, :3]], axis=1)
    normals = _merged(equations[:, :3])
    offsets = (vertices @ normals.T).max(axis=0) + normals @ center
    return Hull(vertices + center, triangles, normals, offsets, edges, sides, float(hull.volume))


def _merged(normals: FloatArray) -> FloatArray:
    _, first = np.unique(np.round(normals / SAME_NORMAL), axis=0, return_index=True)
    return normals[np.sort(first)]
