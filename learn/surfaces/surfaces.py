"""Surfaces chamfered, bent, cut finer, taken apart, opened, made thin, doubled, inside out."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import product

import numpy as np
from scipy.spatial import ConvexHull

from asset_factory.factory.geometry.triangles import doubled_normals
from asset_factory.factory.mesh import BoolArray, FloatArray, IntArray

from .labelled import Labelled, joined, some

#: Gaps between quads that were one solid [m], drawn evenly over the orders of magnitude.
SPLIT_M = (3e-5, 2e-3)
#: What is no deeper than this share of its width or height, whichever is more, is a panel.
FLAT = 0.35
#: Of an object smaller than this, changes are as much smaller [m].
COMMON_SIZE = 0.6
#: Objects are not cut finer beyond about so many faces.
MOST_FACES = 6000


def bevelled(mesh: Labelled, rng: np.random.Generator, share: float = 0.6) -> Labelled:
    """Chamfer the edges of boxes, alike on all edges of one; other pieces stay."""
    chosen = boxes_among(mesh) & some(rng, mesh.piece_count, share)
    low, high = (corner[chosen][:, None] for corner in mesh.boxes())
    half = (high - low) / 2.0
    widest = 0.7 * half.min(axis=2)
    chamfer = np.minimum(widest[:, 0], np.exp(rng.uniform(np.log(5e-4), np.log(1e-2), len(half))))
    signs, inset, faces = _chamfered_box()
    vertices = low + half + signs * (half - chamfer[:, None, None] * inset)
    faces = faces + len(signs) * np.arange(len(half))[:, None, None]
    label = np.repeat(mesh.piece_labels[chosen], faces.shape[1], axis=0)
    label[:, 1] = np.repeat(np.arange(len(half)), faces.shape[1])
    boxes = Labelled(vertices.reshape(-1, 3), faces.reshape(-1, 3), label)
    return joined([boxes, mesh.chosen(~chosen[mesh.piece])])


def boxes_among(mesh: Labelled) -> BoolArray:
    """Return which pieces are upright boxes of twelve triangles, shape [piece_count]."""
    low, high = mesh.boxes()
    x, y, z = (high - low).T
    whole = 2.0 * (x * y + y * z + z * x)
    off = np.abs(np.bincount(mesh.piece, mesh.areas) - whole)
    return np.asarray((np.bincount(mesh.piece) == 12) & (off < 1e-6 * np.maximum(whole, 1e-12)))


@cache
def _chamfered_box() -> tuple[FloatArray, FloatArray, IntArray]:
    """Return signs of 24 corners, along which axes each is set back, and 44 outward triangles."""
    signs = np.repeat(np.array(list(product((-1.0, 1.0), repeat=3))), 3, axis=0)
    inset = np.tile(1.0 - np.eye(3), (8, 1))
    hull = ConvexHull(signs * (1.0 - 0.2 * inset))
    faces = np.asarray(hull.simplices, dtype=np.int64)
    normals = doubled_normals(hull.points[faces])
    inward = np.einsum("ij,ij->i", normals, hull.equations[:, :3]) < 0.0
    return signs, inset, np.where(inward[:, None], faces[:, ::-1], faces)


def curved(mesh: Labelled, rng: np.random.Generator, share: float = 0.5) -> Labelled:
    """Bulge moving panels forwards, by up to 3 cm, across width, height or both."""
    for part in range(1, int(mesh.part.max()) + 1):
        own = mesh.part == part
        finer = len(mesh.faces) + 15 * int(own.sum())
        if not own.any() or rng.random() >= share or finer > MOST_FACES:
            continue
        low, high = mesh.chosen(own).bounds
        extents = high - low
        if extents[1] > FLAT * max(extents[0], extents[2]):
            continue
        mesh = quartered(mesh, own)
        mesh = quartered(mesh, mesh.part == part)
        moved = np.unique(mesh.faces[mesh.part == part])
        across = 2.0 * (mesh.vertices[moved] - low) / np.maximum(extents, 1e-9) - 1.0
        ways = ([0], [2], [0, 2])[int(rng.integers(3))]
        height = np.prod(1.0 - np.clip(across[:, ways], -1.0, 1.0) ** 2, axis=1)
        vertices = mesh.vertices.copy()
        bulge = rng.uniform(0.005, 0.03) * min(1.0, float(extents.max()) / 0.4)
        vertices[moved, 1] -= bulge * height
        mesh = replace(mesh, vertices=vertices)
    return mesh


def snapped(mesh: Labelled, rng: np.random.Generator) -> Labelled:
    """Return the vertices on a grid of up to 4 mm: boards that nearly meet share edges."""
    step = float(rng.choice([0.002, 0.003, 0.004])) * min(1.0, mesh.longest / COMMON_SIZE)
    rounded = replace(mesh, vertices=np.round(mesh.vertices / step) * step)
    return rounded.without(rounded.areas < 1e-3 * step**2)


def exploded(mesh: Labelled, rng: np.random.Generator, share: float = 0.4) -> Labelled:
    """Take pieces apart into their sides, each a sheet a hair smaller than it was."""
    chosen = some(rng, mesh.piece_count, share)[mesh.piece]
    gap = float(np.exp(rng.uniform(*np.log(SPLIT_M)))) * min(1.0, mesh.longest)
    label = mesh.label.copy()
    label[:, 1] = sides(mesh)
    apart = replace(mesh, label=label).chosen(chosen)
    return joined([apart.grown(-gap, 0.8) if chosen.any() else apart, mesh.chosen(~chosen)])


def patched(mesh: Labelled, rng: np.random.Generator, share: float = 0.15) -> Labelled:
    """Cut single sides of pieces finer, so that vertices lie within others' edges."""
    side = np.unique(sides(mesh), return_inverse=True)[1].reshape(-1)
    return quartered(mesh, some(rng, int(side.max()) + 1, share)[side])


def subdivided(mesh: Labelled, rng: np.random.Generator, share: float = 0.3) -> Labelled:
    """Cut whole pieces finer, once or twice."""
    chosen = some(rng, mesh.piece_count, share)
    for _ in range(int(rng.integers(1, 3))):
        faces = chosen[mesh.piece]
        if len(mesh.faces) + 3 * int(faces.sum()) <= MOST_FACES:
            mesh = quartered(mesh, faces)
    return mesh


def quartered(mesh: Labelled, chosen: BoolArray) -> Labelled:
    """Return the chosen faces as four each, cut through the middles of their edges."""
    faces = mesh.faces[chosen]
    ends = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    key, inverse = np.unique(ends[:, 0] * len(mesh.vertices) + ends[:, 1], return_inverse=True)
    first, second = np.divmod(key, len(mesh.vertices))
    a, b, c = faces.T
    ab, bc, ca = (len(mesh.vertices) + inverse.reshape(-1, 3)).T
    quarters = np.stack([a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca], axis=1).reshape(-1, 3)
    rows = np.concatenate([np.flatnonzero(~chosen), np.repeat(np.flatnonzero(chosen), 4)])
    return Labelled(
        np.concatenate([mesh.vertices, (mesh.vertices[first] + mesh.vertices[second]) / 2.0]),
        np.concatenate([mesh.faces[~chosen], quarters]),
        mesh.label[rows],
    )


def sides(mesh: Labelled) -> IntArray:
    """Return a number for the piece of each face and the way it looks, shape [face_count]."""
    return mesh.piece * 6 + facing(mesh)


def facing(mesh: Labelled) -> IntArray:
    """Return where a face looks, by the largest part of its normal, shape [face_count].

    0 to 2 stand for -x, -y, -z, 3 to 5 for +x, +y, +z.
    """
    crosses = mesh.crosses
    axis = np.abs(crosses).argmax(axis=1)
    return np.asarray(axis + 3 * (crosses[np.arange(len(crosses)), axis] > 0.0), dtype=np.int64)


def opened(mesh: Labelled, rng: np.random.Generator, share: float = 0.5) -> Labelled:
    """Open pieces on one or two sides of their boxes: a box becomes five quads."""
    gone = some(rng, 6 * mesh.piece_count, 0.25).reshape(-1, 6)
    gone &= some(rng, mesh.piece_count, share)[:, None]
    return mesh.without(gone[mesh.piece, facing(mesh)])


def without_sides(mesh: Labelled, rng: np.random.Generator) -> Labelled:
    """Return the whole object without its back, its underside, or both: nobody looks there."""
    low, high = mesh.bounds
    margin = 0.01 * mesh.longest
    corners = mesh.corners
    side = facing(mesh)
    back = (side == 4) & (corners[:, :, 1].min(axis=1) > high[1] - margin)
    under = (side == 2) & (corners[:, :, 2].max(axis=1) < low[2] + margin)
    which = int(rng.integers(3))
    return mesh.without((back & (which != 1)) | (under & (which != 0)))


def flattened(mesh: Labelled, rng: np.random.Generator, share: float) -> Labelled:
    """Return a share of the thin pieces as a single sheet, one side of the two; edges are dropped.

    Thin means at most 3 cm, and less on a small object.
    """
    low, high = mesh.boxes()
    thin, wide, _ = np.sort(high - low, axis=1).T
    chosen = (thin < min(0.03, 0.06 * mesh.longest)) & (wide > 3.0 * thin)
    chosen &= some(rng, mesh.piece_count, share)
    across = (high - low).argmin(axis=1)
    # A front is seen from the front.
    upper = some(rng, mesh.piece_count, 0.5) & (across != 1)
    wanted = (across + 3 * upper)[mesh.piece]
    return mesh.without(chosen[mesh.piece] & (facing(mesh) != wanted))


def doubled(mesh: Labelled, rng: np.random.Generator, share: float = 1.0) -> Labelled:
    """Double faces the other way round, on the same vertices or on others in their place."""
    chosen = some(rng, mesh.piece_count, share)[mesh.piece]
    apart = len(mesh.vertices) if rng.random() < 0.5 else 0
    vertices = np.concatenate([mesh.vertices, mesh.vertices]) if apart else mesh.vertices
    faces = np.concatenate([mesh.faces, mesh.faces[chosen][:, ::-1] + apart])
    return Labelled(vertices, faces, np.concatenate([mesh.label, mesh.label[chosen]]))


def flipped(mesh: Labelled, rng: np.random.Generator, share: float = 0.3) -> Labelled:
    """Return the pieces turned inside out."""
    chosen = some(rng, mesh.piece_count, share)[mesh.piece]
    return replace(mesh, faces=np.where(chosen[:, None], mesh.faces[:, ::-1], mesh.faces))
