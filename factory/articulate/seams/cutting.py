"""A mesh cut along planes, so that a part ends where its outline does."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...geometry.triangles import ends_of
from ...mesh import BoolArray, FloatArray, IntArray, Mesh

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

    def same(self, other: Region) -> bool:
        """Return whether the other one has the same planes."""
        return np.array_equal(self.normals, other.normals) and np.array_equal(
            self.offsets, other.offsets
        )


@dataclass(frozen=True, eq=False)
class CutMesh:
    """A mesh after some cuts.

    Attributes:
        mesh: the same surface, some triangles divided.
        source: which triangle of the first mesh each one lies on, shape [face_count].
    """

    mesh: Mesh
    source: IntArray


def uncut(mesh: Mesh) -> CutMesh:
    """Return a mesh before any cut."""
    return CutMesh(mesh, np.arange(len(mesh.faces)))


def cut_around(cut: CutMesh, region: Region) -> CutMesh:
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


def centred_in(mesh: Mesh, region: Region) -> BoolArray:
    """Return which triangles have their middle in a region, cut or not, shape [face_count]."""
    middles = mesh.vertices[mesh.faces].mean(axis=1)
    return np.asarray((middles @ region.normals.T <= region.offsets).all(axis=1))


def inside(mesh: Mesh, region: Region) -> BoolArray:
    """Return which triangles lie in a region they were cut around, shape [face_count]."""
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
    ends = mesh.faces[faces][:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
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
    edges = mesh.faces[own][:, [[0, 1], [1, 2], [2, 0]]]
    place = np.minimum(np.searchsorted(keys, _keys(edges, count)), len(keys) - 1)
    divided = keys[place] == _keys(edges, count)
    along = np.where(edges[..., 0] < edges[..., 1], share[place], 1.0 - share[place])
    vertices = np.concatenate([mesh.vertices, points])
    return _refined(cut, vertices, _Divided(own, divided, count + place, along))


@dataclass(frozen=True, eq=False)
class _Divided:
    """Triangles with the points that divide their edges 0-1, 1-2 and 2-0.

    Attributes:
        faces: which triangles, shape [n].
        edges: which of their edges are divided, shape [n, 3].
        place: by which vertex, shape [n, 3].
        along: how far from an edge's first corner, 0 to 1, shape [n, 3].
    """

    faces: IntArray
    edges: BoolArray
    place: IntArray
    along: FloatArray


def _keys(edges: IntArray, count: int) -> IntArray:
    return np.asarray(edges.min(axis=-1) * count + edges.max(axis=-1))


#: Corners 0 to 2 are a triangle's own, 3 to 5 lie on its edges 0-1, 1-2, 2-0; by what is divided.
_PIECES = {
    (True, False, False): ((0, 3, 2), (3, 1, 2)),
    (False, True, False): ((1, 4, 0), (4, 2, 0)),
    (False, False, True): ((2, 5, 1), (5, 0, 1)),
    (True, True, False): ((3, 1, 4), (0, 3, 4), (0, 4, 2)),
    (False, True, True): ((4, 2, 5), (1, 4, 5), (1, 5, 0)),
    (True, False, True): ((5, 0, 3), (2, 5, 3), (2, 3, 1)),
    (True, True, True): ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)),
}


def _refined(cut: CutMesh, vertices: FloatArray, divided: _Divided) -> CutMesh:
    """Return every triangle with divided edges replaced by its pieces, at the end of the mesh."""
    mesh = cut.mesh
    whole = np.ones(len(mesh.faces), dtype=np.bool_)
    whole[divided.faces[divided.edges.any(axis=1)]] = False
    kept = np.flatnonzero(whole)
    owners = []
    corners = []
    for pattern, pieces in _PIECES.items():
        those = np.flatnonzero((divided.edges == np.array(pattern)).all(axis=1))
        for piece in pieces:
            owners.append(those)
            corners.append(np.broadcast_to(np.array(piece), (len(those), 3)))
    owner = np.concatenate(owners)
    corner = np.concatenate(corners)
    face = divided.faces[owner]
    six = np.concatenate([mesh.faces[face], divided.place[owner]], axis=1)
    along = divided.along[owner]
    source = np.concatenate([kept, face])

    def spread(values: FloatArray | None, *, unit: bool) -> FloatArray | None:
        if values is None:
            return None
        return np.concatenate([values[kept], _spread(values[face], along, corner, unit=unit)])

    pieces_of = np.take_along_axis(six, corner, axis=1)
    refined = replace(
        mesh,
        vertices=vertices,
        faces=np.concatenate([mesh.faces[kept], pieces_of]),
        corner_uv=spread(mesh.corner_uv, unit=False),
        corner_normals=spread(mesh.corner_normals, unit=True),
        face_material=mesh.face_material[source],
    )
    return CutMesh(refined, cut.source[source])


def _spread(own: FloatArray, along: FloatArray, corner: IntArray, *, unit: bool) -> FloatArray:
    """Return what the corners of pieces have, between what their triangle's corners had."""
    between = own + along[..., None] * (np.roll(own, -1, axis=1) - own)
    if unit:
        length = np.linalg.norm(between, axis=-1, keepdims=True)
        between = between / np.where(length > 0.0, length, 1.0)
    six = np.concatenate([own, between], axis=1)
    return np.asarray(np.take_along_axis(six, corner[..., None], axis=1))
