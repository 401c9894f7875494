"""Boxes with chamfered edges, and panels that are not flat."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
from scipy.spatial import ConvexHull

from ....mesh import FloatArray, IntArray
from .divided import quartered
from .labelled import BoolArray, Labelled, joined, some

#: What is no deeper than this share of its width or height, whichever is more, is a panel.
FLAT = 0.35
#: Of an object smaller than this, changes are as much smaller [m].
COMMON_SIZE = 0.6


def bevelled(mesh: Labelled, rng: np.random.Generator, share: float = 0.6) -> Labelled:
    """Boxes with chamfered edges, each chamfer the same on all edges of a box; other pieces stay as they are."""
    chosen = boxes_among(mesh) & some(rng, mesh.piece_count, share)
    if not chosen.any():
        return mesh
    low, high = (corner[chosen] for corner in mesh.boxes())
    count = len(low)
    widest = 0.35 * (high - low).min(axis=1)
    chamfer = np.minimum(widest, np.exp(rng.uniform(np.log(5e-4), np.log(1e-2), count)))
    signs, inset, faces = _chamfered_box()
    middle, half = (low + high)[:, None] / 2.0, (high - low)[:, None] / 2.0
    vertices = middle + signs * (half - chamfer[:, None, None] * inset)
    of_piece = np.zeros((2, mesh.piece_count), dtype=np.int64)
    of_piece[:, mesh.piece] = mesh.part, mesh.material
    part, material = np.repeat(of_piece[:, chosen], len(faces), axis=1)
    solids = Labelled(
        vertices.reshape(-1, 3),
        (faces + len(signs) * np.arange(count)[:, None, None]).reshape(-1, 3),
        part,
        np.repeat(np.arange(count), len(faces)),
        material,
    )
    others = ~chosen[mesh.piece]
    return joined([solids, mesh.chosen(others)]) if others.any() else solids


def curved(
    mesh: Labelled, rng: np.random.Generator, share: float = 0.5, most: int = 6000
) -> Labelled:
    """Moving panels that bulge forwards, by up to 3 cm, across their width, their height or both."""
    for part in range(1, int(mesh.part.max()) + 1):
        own = mesh.part == part
        if not own.any() or rng.random() >= share or len(mesh.faces) + 15 * int(own.sum()) > most:
            continue
        corners = mesh.corners[own]
        low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
        if high[1] - low[1] > FLAT * max(high[0] - low[0], high[2] - low[2]):
            continue
        mesh = quartered(
            quartered(mesh, own), np.repeat([False, True], [int((~own).sum()), 4 * int(own.sum())])
        )
        across = 2.0 * (mesh.vertices - low) / np.maximum(high - low, 1e-9) - 1.0
        ways = ((0,), (2,), (0, 2))[int(rng.integers(3))]
        height = np.prod([1.0 - np.clip(across[:, axis], -1.0, 1.0) ** 2 for axis in ways], axis=0)
        vertices = mesh.vertices.copy()
        moved = np.unique(mesh.faces[mesh.part == part])
        bulge = rng.uniform(0.005, 0.03) * min(1.0, float((high - low).max()) / 0.4)
        vertices[moved, 1] -= (bulge * height)[moved]
        mesh = replace(mesh, vertices=vertices)
    return mesh


def snapped(mesh: Labelled, rng: np.random.Generator) -> Labelled:
    """Vertices on a grid of up to 4 mm: boards that nearly meet share their edges, lettering lies flush."""
    step = float(rng.choice([0.002, 0.003, 0.004])) * min(1.0, mesh.longest / COMMON_SIZE)
    rounded = replace(mesh, vertices=np.round(mesh.vertices / step) * step)
    return rounded.without(rounded.areas < 1e-3 * step**2)


def boxes_among(mesh: Labelled) -> BoolArray:
    """Which pieces are upright boxes of twelve triangles, shape [piece_count]."""
    low, high = mesh.boxes()
    x, y, z = (high - low).T
    whole = 2.0 * (x * y + y * z + z * x)
    area = np.bincount(mesh.piece, mesh.areas)
    return np.asarray(
        (np.bincount(mesh.piece) == 12) & (np.abs(area - whole) < 1e-6 * np.maximum(whole, 1e-12))
    )


@cache
def _chamfered_box() -> tuple[FloatArray, FloatArray, IntArray]:
    """Signs of 24 corners, along which axes each is set back, and 44 outward triangles."""
    corner = np.array(
        [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=np.float64
    )
    signs = np.repeat(corner, 3, axis=0)
    inset = np.tile(1.0 - np.eye(3), (8, 1))
    hull = ConvexHull(signs * (1.0 - 0.2 * inset))
    faces = np.asarray(hull.simplices, dtype=np.int64)
    a, b, c = (hull.points[faces[:, k]] for k in range(3))
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), hull.equations[:, :3]) < 0.0
    return signs, inset, np.where(inward[:, None], faces[:, ::-1], faces)
