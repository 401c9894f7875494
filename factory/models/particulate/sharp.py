"""Edges at which a surface folds: where half of the network's points lie."""

from dataclasses import dataclass

import numpy as np

from ...mesh import FloatArray, IntArray
from .surface import Surface

LEAST_FOLD = np.deg2rad(30.0)
MOST_FOLD = np.deg2rad(150.0)
"""Angle between two faces' normals at a sharp edge [rad]: lower and upper end.

The paper names only the lower end; the released network saw nothing above the upper one, which
also leaves out the two sides of a sheet and neighbours wound against one another."""
MOST_FACES_COMPARED = 8
"""Of the faces along one edge, so a thousand sheets on one edge do not make a million pairs."""


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


def sharp_edges(surface: Surface) -> SharpEdges:
    """Return the edges where some two faces fold by more than 30 and less than 150 degrees."""
    edges = surface.edges
    chosen = np.full(len(edges.ends), -1)
    other = np.full(len(edges.ends), -1)
    counts = edges.counts
    for i in range(min(int(counts.max(initial=0)), MOST_FACES_COMPARED) - 1):
        for j in range(i + 1, min(int(counts.max()), MOST_FACES_COMPARED)):
            open_ = np.flatnonzero((counts > j) & (chosen < 0))
            one = edges.faces[edges.first[open_] + i]
            two = edges.faces[edges.first[open_] + j]
            folds = _folds(surface, one, two)
            chosen[open_[folds]] = one[folds]
            other[open_[folds]] = two[folds]
    sharp = np.flatnonzero(chosen >= 0)
    ends = surface.vertices[edges.ends[sharp]]
    return SharpEdges(
        edges=sharp,
        normals=(surface.normals[chosen[sharp]] + surface.normals[other[sharp]]) / 2.0,
        lengths=np.asarray(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)),
    )


def _folds(surface: Surface, one: IntArray, two: IntArray) -> IntArray:
    cosine = np.einsum("ij,ij->i", surface.normals[one], surface.normals[two])
    solid = (surface.areas[one] > 0.0) & (surface.areas[two] > 0.0)
    return np.flatnonzero(solid & (np.cos(MOST_FOLD) < cosine) & (cosine < np.cos(LEAST_FOLD)))
