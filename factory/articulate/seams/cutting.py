"""A mesh cut along planes, so that a part ends where its outline does."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from ...geometry.cutting import divide
from ...geometry.triangles import FOLLOWING, ends_of
from ...mesh import BoolArray, FloatArray, IntArray, Mesh, unit_rows

#: Vertices nearer to a plane than this share of the diagonal lie on it.
ON_PLANE = 1e-5


@dataclass(frozen=True, eq=False)
class Region:
    """The space inside of several planes.

    Attributes:
        normals: outward unit normals, shape [n, 3].
        offsets: of the planes along them [m], shape [n]; inside is below.
    """

    normals: FloatArray
    offsets: FloatArray

    def turned(self, rotation: FloatArray) -> Region:
        """Return the same turned about the origin; ``rotation`` has shape [3, 3]."""
        return Region(self.normals @ rotation.T, self.offsets)

    def within(self, other: Region) -> Region:
        """Return the space inside of the planes of both."""
        return Region(
            np.concatenate([self.normals, other.normals]),
            np.concatenate([self.offsets, other.offsets]),
        )

    def holds(self, point: FloatArray) -> bool:
        """Return whether a point, shape [3], lies inside."""
        return bool((self.normals @ point <= self.offsets).all())


@dataclass(frozen=True, eq=False)
class CutMesh:
    """A mesh after some cuts.

    Attributes:
        mesh: the same surface, some triangles divided.
        source: which triangle of the first mesh each one lies on, shape [face_count].
    """

    mesh: Mesh
    source: IntArray


def cut_along(mesh: Mesh, regions: Iterable[Region]) -> CutMesh:
    """Cut a mesh along the planes of regions; where none of them cuts it, it is the same mesh."""
    cut = CutMesh(mesh, np.arange(len(mesh.faces)))
    for region in dict.fromkeys(regions):
        cut = _cut_around(cut, region)
    return cut


def _cut_around(cut: CutMesh, region: Region) -> CutMesh:
    """Divide triangles that lie partly inside a region; where none do, nothing changes.

    Neighbours that share a divided edge are divided too, so that the surface stays closed.
    """
    tolerance = ON_PLANE * cut.mesh.diagonal
    near = _near(cut.mesh, region, tolerance)
    for normal, offset in zip(region.normals, region.offsets, strict=True):
        height = cut.mesh.vertices @ normal - offset
        corners = height[cut.mesh.faces[near]]
        low, high = ends_of(corners)
        passes = (low < -tolerance) & (high > tolerance)
        if passes.any():
            cut = _split(cut, height, near[passes], tolerance)
            near = _near(cut.mesh, region, tolerance)
    return cut


def inside(mesh: Mesh, region: Region) -> BoolArray:
    """Return which triangles have their middle in a region, shape [face_count].

    Those that were cut around it lie in it as a whole.
    """
    within = np.ones(len(mesh.faces), dtype=np.bool_)
    for normal, offset in zip(region.normals, region.offsets, strict=True):
        height = mesh.vertices @ normal - offset
        within &= sum(height[mesh.faces[:, corner]] for corner in range(3)) <= 0.0
    return within


def _near(mesh: Mesh, region: Region, tolerance: float) -> IntArray:
    """Return triangles that may reach into a region: none of its planes has all corners outside."""
    near = np.ones(len(mesh.faces), dtype=np.bool_)
    for normal, offset in zip(region.normals, region.offsets, strict=True):
        outside = mesh.vertices @ normal - offset > -tolerance
        near &= ~(outside[mesh.faces[:, 0]] & outside[mesh.faces[:, 1]] & outside[mesh.faces[:, 2]])
    return np.flatnonzero(near)


def _split(cut: CutMesh, height: FloatArray, faces: IntArray, tolerance: float) -> CutMesh:
    """Divide the edges of some triangles where they pass through height 0."""
    mesh = cut.mesh
    count = len(mesh.vertices)
    ends = _edges(mesh.faces[faces]).reshape(-1, 2)
    through = (height[ends].min(axis=1) < -tolerance) & (height[ends].max(axis=1) > tolerance)
    keys = np.unique(_keys(ends[through], count))
    low, high = np.divmod(keys, count)
    share = height[low] / (height[low] - height[high])
    points = mesh.vertices[low] + share[:, None] * (mesh.vertices[high] - mesh.vertices[low])
    # Only triangles with two corners on divided edges can have one.
    touched = np.zeros(count, dtype=np.int64)
    touched[low] = 1
    touched[high] = 1
    some = sum(touched[mesh.faces[:, corner]] for corner in range(3)) >= 2
    own = np.flatnonzero(some)
    kept = np.flatnonzero(~some)
    edges = _edges(mesh.faces[own])
    place = np.minimum(np.searchsorted(keys, _keys(edges, count)), len(keys) - 1)
    divided = keys[place] == _keys(edges, count)
    along = np.where(edges[..., 0] < edges[..., 1], share[place], 1.0 - share[place])
    pieces = divide(divided, along)
    six = np.concatenate([mesh.faces[own], count + place], axis=1)
    source = np.concatenate([kept, own[pieces.whole]])

    def spread(values: FloatArray | None) -> FloatArray | None:
        if values is None:
            return None
        return np.concatenate([values[kept], pieces.spread(values[own])])

    normals = spread(mesh.corner_normals)
    refined = replace(
        mesh,
        vertices=np.concatenate([mesh.vertices, points]),
        faces=np.concatenate([mesh.faces[kept], six[pieces.whole[:, None], pieces.corner]]),
        corner_uv=spread(mesh.corner_uv),
        corner_normals=None if normals is None else unit_rows(normals),
        face_material=mesh.face_material[source],
    )
    return CutMesh(refined, cut.source[source])


def _edges(faces: IntArray) -> IntArray:
    """Return the ends of every triangle's edges 0-1, 1-2 and 2-0, shape [face_count, 3, 2]."""
    return np.stack([faces, faces[:, FOLLOWING]], axis=2)


def _keys(edges: IntArray, count: int) -> IntArray:
    return np.asarray(edges.min(axis=-1) * count + edges.max(axis=-1))
