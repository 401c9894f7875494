"""A mesh cut along planes, so that a part ends where its outline does."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...geometry.crossings import BoolArray
from ...mesh import FloatArray, IntArray, Mesh

#: Vertices nearer to a plane than this share of the diagonal lie on it.
ON_PLANE = 1e-5


@dataclass(frozen=True, eq=False)
class Region:
    """What lies inside of several planes.

    Attributes:
        normals: outward unit normals, shape [n, 3].
        offsets: of the planes along them [m], shape [n]; inside is below.
    """

    normals: FloatArray
    offsets: FloatArray

    def distances(self, points: FloatArray) -> FloatArray:
        """How far points [m], shape [m, 3], are outside of each plane, shape [m, n]."""
        return np.asarray(points @ self.normals.T - self.offsets)


@dataclass(frozen=True, eq=False)
class Cut:
    """A mesh after some cuts.

    Attributes:
        mesh: the same surface, some triangles divided.
        source: which triangle of the first mesh each one lies on, shape [face_count].
    """

    mesh: Mesh
    source: IntArray


def uncut(mesh: Mesh) -> Cut:
    """A mesh before any cut."""
    return Cut(mesh, np.arange(len(mesh.faces)))


def cut_around(cut: Cut, region: Region) -> Cut:
    """Divide triangles that lie partly inside a region; where none do, nothing changes.

    Neighbours that share a divided edge are divided too, so that the surface stays closed.
    """
    tolerance = ON_PLANE * cut.mesh.diagonal
    for index in range(len(region.offsets)):
        distance = region.distances(cut.mesh.vertices)
        corners = distance[cut.mesh.faces]
        others = np.delete(corners, index, axis=2)
        may = (others.min(axis=1) <= tolerance).all(axis=1)
        height = corners[:, :, index]
        may &= (height.min(axis=1) < -tolerance) & (height.max(axis=1) > tolerance)
        if may.any():
            cut = _split(cut, distance[:, index], np.flatnonzero(may), tolerance)
    return cut


def inside(mesh: Mesh, region: Region) -> BoolArray:
    """Which triangles lie in a region they were cut around, shape [face_count]."""
    middle = mesh.vertices[mesh.faces].mean(axis=1)
    return np.asarray((region.distances(middle) <= 0.0).all(axis=1))


def _split(cut: Cut, height: FloatArray, faces: IntArray, tolerance: float) -> Cut:
    """Divide the edges of some triangles where they pass through height 0."""
    mesh = cut.mesh
    count = len(mesh.vertices)
    ends = mesh.faces[faces][:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    through = (height[ends].min(axis=1) < -tolerance) & (height[ends].max(axis=1) > tolerance)
    keys = np.unique(_keys(ends[through], count))
    low, high = np.divmod(keys, count)
    share = height[low] / (height[low] - height[high])
    points = mesh.vertices[low] + share[:, None] * (mesh.vertices[high] - mesh.vertices[low])
    edges = mesh.faces[:, [[0, 1], [1, 2], [2, 0]]]
    place = np.searchsorted(keys, _keys(edges, count))
    place = np.minimum(place, len(keys) - 1)
    divided = keys[place] == _keys(edges, count)
    along = np.where(edges[..., 0] < edges[..., 1], share[place], 1.0 - share[place])
    return _refined(cut, np.concatenate([mesh.vertices, points]), divided, count + place, along)


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


def _refined(
    cut: Cut, vertices: FloatArray, divided: BoolArray, place: IntArray, along: FloatArray
) -> Cut:
    """Every triangle with divided edges replaced by its pieces, at the end of the mesh."""
    mesh = cut.mesh
    six = np.concatenate([mesh.faces, place], axis=1)
    kept = np.flatnonzero(~divided.any(axis=1))
    owner = [kept]
    corners = [np.broadcast_to(np.arange(3), (len(kept), 3))]
    for pattern, pieces in _PIECES.items():
        those = np.flatnonzero((divided == np.array(pattern)).all(axis=1))
        for piece in pieces:
            owner.append(those)
            corners.append(np.broadcast_to(np.array(piece), (len(those), 3)))
    source = np.concatenate(owner)
    corner = np.concatenate(corners)
    return Cut(
        replace(
            mesh,
            vertices=vertices,
            faces=np.take_along_axis(six[source], corner, axis=1),
            corner_uv=_spread(mesh.corner_uv, along, source, corner, unit=False),
            corner_normals=_spread(mesh.corner_normals, along, source, corner, unit=True),
            face_material=mesh.face_material[source],
        ),
        cut.source[source],
    )


def _spread(
    values: FloatArray | None, along: FloatArray, source: IntArray, corner: IntArray, *, unit: bool
) -> FloatArray | None:
    """What the corners of the pieces have, between what the corners of the triangles had."""
    if values is None:
        return None
    own = values[source]
    share = along[source][..., None]
    between = own + share * (np.roll(own, -1, axis=1) - own)
    if unit:
        length = np.linalg.norm(between, axis=-1, keepdims=True)
        between = between / np.where(length > 0.0, length, 1.0)
    six = np.concatenate([own, between], axis=1)
    return np.asarray(np.take_along_axis(six, corner[..., None], axis=1))
