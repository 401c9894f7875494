"""What nobody sees from outside, and meshes without it."""

from __future__ import annotations

import numpy as np

from ....mesh import FloatArray
from .labelled import BoolArray, Labelled

#: Points tried on the surface, and pixels along a picture's side.
POINTS, PIXELS = 8000, 24
#: Depth by which a point may lie behind what is seen in its pixel, as a share of the longest side.
SLACK = 0.02
#: Share of a face's points that are seen by mistake, through pixels that no nearer point happens to
#: fill.
LEAKS = 0.15
#: A piece counts as hidden if this share of its surface is.
MOSTLY = 0.7


def hidden_faces(mesh: Labelled, rng: np.random.Generator) -> BoolArray:
    """Faces of which no point is seen from any of 14 directions, shape [face_count].

    Points on the surface are drawn into depth pictures; a face counts as hidden if hardly any of
    its points is in front.
    """
    areas = mesh.areas
    share = np.cumsum(areas / areas.sum())
    more = np.minimum(np.searchsorted(share, rng.random(POINTS)), len(areas) - 1)
    face = np.concatenate([np.arange(len(areas)), more])
    u, v = rng.random((2, len(face)))
    root = np.sqrt(u)
    weights = np.stack([1.0 - root, root * (1.0 - v), root * v], axis=1)
    points = np.einsum("ni,nij->nj", weights, mesh.corners[face])
    low, high = points.min(axis=0), points.max(axis=0)
    points = (points - (low + high) / 2.0) / (high - low).max()
    seen = np.zeros(len(points), dtype=bool)
    for direction in _directions():
        side = np.cross(direction, (0.31, 0.52, 0.8))
        side /= np.linalg.norm(side)
        across = points @ np.stack([side, np.cross(direction, side)], axis=1)
        # Half the diagonal of the unit box is 0.87.
        column, row = ((across / 0.9 + 1.0) * (PIXELS / 2)).astype(np.int64).T
        pixel = row * PIXELS + column
        depth = points @ direction
        nearest = np.full(PIXELS * PIXELS, -np.inf)
        np.maximum.at(nearest, pixel, depth)
        seen |= depth > nearest[pixel] - SLACK
    return np.asarray(np.bincount(face, seen, minlength=len(areas)) <= LEAKS * np.bincount(face))


def without_hidden(mesh: Labelled, rng: np.random.Generator) -> Labelled:
    """No faces that are hidden from everywhere outside."""
    return mesh.without(hidden_faces(mesh, rng))


def without_hidden_pieces(mesh: Labelled, rng: np.random.Generator) -> Labelled:
    """No pieces most of which is hidden: an object without its inside."""
    areas = mesh.areas
    hidden = np.bincount(mesh.piece, areas * hidden_faces(mesh, rng))
    mostly = hidden > MOSTLY * np.bincount(mesh.piece, areas)
    return mesh.without(mostly[mesh.piece])


def _directions() -> FloatArray:
    corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    sides = (
        [(x, 0, 0) for x in (-1, 1)] + [(0, y, 0) for y in (-1, 1)] + [(0, 0, z) for z in (-1, 1)]
    )
    # Slightly aslant, so that no picture looks exactly along a board.
    directions = np.array([*corners, *sides], dtype=np.float64) + np.array([0.11, 0.07, 0.05])
    return np.asarray(directions / np.linalg.norm(directions, axis=1, keepdims=True))
