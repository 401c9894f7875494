"""Surfaces cut into more, or into separate, pieces."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ....mesh import IntArray
from .labelled import BoolArray, Labelled, joined, some

#: Gaps between quads that were one solid [m], drawn evenly over the orders of magnitude.
SPLIT_M = (3e-5, 2e-3)


def exploded(mesh: Labelled, rng: np.random.Generator, share: float = 0.4) -> Labelled:
    """Pieces taken apart into their sides, each a sheet of its own, a hair smaller than it was."""
    chosen = some(rng, mesh.piece_count, share)[mesh.piece]
    if not chosen.any():
        return mesh
    gap = float(np.exp(rng.uniform(*np.log(SPLIT_M)))) * min(1.0, mesh.longest)
    apart = mesh.chosen(chosen)
    apart = replace(
        apart, piece=np.unique(sides(apart), return_inverse=True)[1].reshape(-1)
    ).with_own_vertices()
    low, high = apart.boxes()
    middle, half = (low + high) / 2.0, np.maximum((high - low) / 2.0, 1e-9)
    piece = np.zeros(len(apart.vertices), dtype=np.int64)
    piece[apart.faces] = apart.piece[:, None]
    factor = np.maximum(1.0 - gap / half, 0.8)[piece]
    apart = replace(apart, vertices=middle[piece] + (apart.vertices - middle[piece]) * factor)
    return joined([apart, mesh.chosen(~chosen)]) if not chosen.all() else apart


def patched(mesh: Labelled, rng: np.random.Generator, share: float = 0.15) -> Labelled:
    """Single sides of pieces cut finer than what they border on: vertices lie within neighbours' edges."""
    side = np.unique(sides(mesh), return_inverse=True)[1].reshape(-1)
    return quartered(mesh, some(rng, int(side.max()) + 1, share)[side])


def subdivided(
    mesh: Labelled, rng: np.random.Generator, share: float = 0.3, most: int = 6000
) -> Labelled:
    """Whole pieces cut finer, once or twice, as long as there are not more than about ``most`` faces."""
    chosen = some(rng, mesh.piece_count, share)
    for _ in range(int(rng.integers(1, 3))):
        faces = chosen[mesh.piece]
        if len(mesh.faces) + 3 * int(faces.sum()) > most:
            break
        mesh = quartered(mesh, faces)
    return mesh


def quartered(mesh: Labelled, chosen: BoolArray) -> Labelled:
    """The chosen faces as four each, cut through the middles of their edges."""
    if not chosen.any():
        return mesh
    faces = mesh.faces[chosen]
    ends = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    key, inverse = np.unique(ends[:, 0] * len(mesh.vertices) + ends[:, 1], return_inverse=True)
    first, second = np.divmod(key, len(mesh.vertices))
    middle = len(mesh.vertices) + inverse.reshape(-1, 3)
    (a, b, c), (ab, bc, ca) = faces.T, middle.T
    quarters = np.stack([a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca], axis=1).reshape(-1, 3)
    rows = np.concatenate([np.flatnonzero(~chosen), np.repeat(np.flatnonzero(chosen), 4)])
    return Labelled(
        np.concatenate([mesh.vertices, (mesh.vertices[first] + mesh.vertices[second]) / 2.0]),
        np.concatenate([mesh.faces[~chosen], quarters]),
        mesh.part[rows],
        mesh.piece[rows],
        mesh.material[rows],
    )


def sides(mesh: Labelled) -> IntArray:
    """A number for the piece of each face and the way it looks (along -x, -y, -z, +x, +y or +z), shape [face_count]."""
    return mesh.piece * 6 + facing(mesh)


def facing(mesh: Labelled) -> IntArray:
    """Where a face looks, shape [face_count]: 0 to 2 along -x, -y, -z, 3 to 5 along +x, +y, +z, by its largest part."""
    crosses = mesh.crosses
    axis = np.abs(crosses).argmax(axis=1)
    return np.asarray(axis + 3 * (crosses[np.arange(len(crosses)), axis] > 0.0), dtype=np.int64)
