"""A mesh as the network's preparation sees it: welded corners, areas, normals, neighbours."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...geometry.edges import label_linked, shared_edges
from ...geometry.rows import distinct_rows, weld_points
from ...geometry.triangles import doubled_normals
from ...mesh import BoolArray, FloatArray, IntArray

WELD_SHARE = 1e-8
"""Corners closer than this share of the box's longest side are one vertex."""
LEAST_HEIGHT = 1e-9
"""A face no higher than this share of its longest edge has no area, and no normal."""

LEAST_FOLD = np.deg2rad(30.0)
MOST_FOLD = np.deg2rad(150.0)
"""Angle between two faces' normals at a sharp edge [rad]: lower and upper end.

The paper names only the lower end; the released network saw nothing above the upper one, which
also leaves out the two sides of a sheet and neighbours wound against one another."""
MOST_FACES_COMPARED = 8
"""Of the faces along one edge, so a thousand sheets on one edge do not make a million pairs."""

FLAT_DEG = 0.05
SHARP_DEG = 15.0
"""Two faces that turn less lie in one plane; two that turn more meet in an edge [deg]."""
CRISP = 0.5
"""Of a reconstructed surface's borders between faces at most so much is flat or sharp, by length:
0.08 to 0.31 of 13 generated meshes and 33 objects made skins, 0.67 to 0.98 of 8 modelled ones."""


@dataclass(frozen=True)
class Edges:
    """Every edge once, with the faces along it.

    Attributes:
        ends: vertex indices, ascending, shape [edge_count, 2].
        first: of edge ``e`` the faces are ``faces[first[e] : first[e + 1]]``, shape [edge_count +
            1].
        faces: face indices, ascending within an edge.
    """

    ends: IntArray
    first: IntArray
    faces: IntArray

    @property
    def counts(self) -> IntArray:
        """Return how many faces lie along each edge, shape [edge_count]."""
        return np.diff(self.first)


@dataclass(frozen=True)
class SharpEdges:
    """Where a surface folds.

    Attributes:
        edges: indices into the surface's edges, shape [sharp_count].
        normals: mean of two unit face normals there, *not* normalised, as the network knows it,
            shape [sharp_count, 3].
        lengths: [length units], shape [sharp_count].
    """

    edges: IntArray
    normals: FloatArray
    lengths: FloatArray


@dataclass(frozen=True)
class Surface:
    """Triangles whose corners are welded by position, so that a texture seam is no border.

    Attributes:
        vertices: positions [length units], shape [vertex_count, 3].
        faces: welded vertex indices, shape [face_count, 3]; in the order of the mesh they came
            from.
    """

    vertices: FloatArray
    faces: IntArray

    @classmethod
    def of(cls, vertices: FloatArray, faces: IntArray) -> Surface:
        """Return the surface of any triangles; each face keeps its index and its exact corners."""
        used = vertices[np.unique(faces)] if len(faces) else np.zeros((1, 3))
        low = used.min(axis=0)
        high = used.max(axis=0)
        step = WELD_SHARE * max(float((high - low).max()), np.finfo(np.float64).tiny / WELD_SHARE)
        first, group = weld_points(np.clip(vertices, low, high), low, step)
        return cls(vertices[first], group[faces])

    @cached_property
    def crosses(self) -> FloatArray:
        """Cross product of two sides of each face: normal, twice its area long, [face_count, 3]."""
        return doubled_normals(self.vertices[self.faces])

    @cached_property
    def areas(self) -> FloatArray:
        """Return the area of each face, 0 for slivers, shape [face_count]."""
        a, b, c = (self.vertices[self.faces[:, k]] for k in range(3))
        longest = np.maximum(np.maximum(_squared(b - a), _squared(c - b)), _squared(a - c))
        doubled = np.linalg.norm(self.crosses, axis=1)
        return np.asarray(np.where(doubled > LEAST_HEIGHT * longest, doubled / 2.0, 0.0))

    @cached_property
    def normals(self) -> FloatArray:
        """Return the unit normals, zero for faces without area, shape [face_count, 3]."""
        solid = self.areas > 0.0
        scale = np.where(solid, 0.5 / np.where(solid, self.areas, 1.0), 0.0)
        return np.asarray(self.crosses * scale[:, None])

    @cached_property
    def edges(self) -> Edges:
        """Return all edges of faces with three different corners."""
        chosen = np.flatnonzero(has_three_corners(self.faces))
        owner = np.repeat(chosen, 3)
        ends = np.sort(self.faces[chosen][:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        key = ends[:, 0] * (int(self.faces.max(initial=0)) + 1) + ends[:, 1]
        order = np.argsort(key, kind="stable")
        starts = np.flatnonzero(np.diff(key[order], prepend=-1))
        return Edges(ends[order[starts]], np.append(starts, len(key)), owner[order])

    @cached_property
    def sharp(self) -> SharpEdges:
        """Return the edges where some two faces fold by more than 30 and less than 150 degrees."""
        edges = self.edges
        chosen = np.full(len(edges.ends), -1)
        other = np.full(len(edges.ends), -1)
        counts = edges.counts
        for i in range(min(int(counts.max(initial=0)), MOST_FACES_COMPARED) - 1):
            for j in range(i + 1, min(int(counts.max()), MOST_FACES_COMPARED)):
                open_ = np.flatnonzero((counts > j) & (chosen < 0))
                one = edges.faces[edges.first[open_] + i]
                two = edges.faces[edges.first[open_] + j]
                folds = _folds(self, one, two)
                chosen[open_[folds]] = one[folds]
                other[open_[folds]] = two[folds]
        sharp = np.flatnonzero(chosen >= 0)
        ends = self.vertices[edges.ends[sharp]]
        return SharpEdges(
            edges=sharp,
            normals=(self.normals[chosen[sharp]] + self.normals[other[sharp]]) / 2.0,
            lengths=np.asarray(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)),
        )

    @cached_property
    def neighbours(self) -> IntArray:
        """Return the pairs of faces that border on one another, shape [pair_count, 2].

        They share an edge that no third face shares: boxes that only touch along an edge stay
        apart. Faces on the same three corners count once and border on one another, so that a
        double-sided sheet hangs together.
        """
        proper = np.flatnonzero(has_three_corners(self.faces))
        corners = np.sort(self.faces[proper], axis=1)
        first, group = distinct_rows(corners)
        original = proper[first][group]
        twins = np.stack([original, proper], axis=1)[original != proper]
        rows = np.sort(proper[first])
        return np.concatenate([rows[shared_edges(self.faces[rows]).faces], twins])

    @cached_property
    def components(self) -> IntArray:
        """Return the number of each face's component, in first-face order, shape [face_count]."""
        return label_linked(len(self.faces), self.neighbours)

    @cached_property
    def borders(self) -> FloatArray:
        """Return the length that each pair of neighbours shares, shape [pair_count]."""
        one, other = self.faces[self.neighbours].transpose(1, 0, 2)
        shared = (one[:, :, None] == other[:, None, :]).any(axis=2)
        ends = np.argsort(~shared, axis=1, kind="stable")[:, :2]
        first, last = self.vertices[np.take_along_axis(one, ends, axis=1)].transpose(1, 0, 2)
        return np.asarray(np.linalg.norm(last - first, axis=1))

    @cached_property
    def reconstructed(self) -> bool:
        """Return whether the surface bends a little nearly everywhere, as nobody models it.

        Modelled surfaces are flat or turn sharply over most of the borders between their faces.
        """
        one, other = self.normals[self.neighbours].transpose(1, 0, 2)
        turn = np.degrees(np.arccos(np.clip(np.einsum("ij,ij->i", one, other), -1.0, 1.0)))
        crisp = (turn < FLAT_DEG) | (turn > SHARP_DEG)
        return bool(self.borders[crisp].sum() < CRISP * self.borders.sum())


def has_three_corners(faces: IntArray) -> BoolArray:
    """Return whether a face's corners are different vertices, shape [face_count]."""
    return np.asarray((faces != np.roll(faces, 1, axis=1)).all(axis=1), dtype=np.bool_)


def last_of(following: IntArray) -> IntArray:
    """Return where chains end in which each thing names the one after it, or itself, [count]."""
    while not np.array_equal(following, following[following]):
        following = following[following]
    return following


def _squared(vectors: FloatArray) -> FloatArray:
    return np.asarray(np.einsum("ij,ij->i", vectors, vectors))


def _folds(surface: Surface, one: IntArray, two: IntArray) -> IntArray:
    cosine = np.einsum("ij,ij->i", surface.normals[one], surface.normals[two])
    solid = (surface.areas[one] > 0.0) & (surface.areas[two] > 0.0)
    return np.flatnonzero(solid & (np.cos(MOST_FOLD) < cosine) & (cosine < np.cos(LEAST_FOLD)))
