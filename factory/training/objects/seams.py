"""Cut a labelled surface where the label changes, so that seams are lines and not saw teeth."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...mesh import FloatArray, IntArray

#: Halvings of an edge in search of its seam: an edge of some centimetres is cut to a few
#: micrometres.
HALVINGS = 12
#: Points tried along each side of a triangle in which three parts meet.
GRID = 24


def cut_along_labels(
    vertices: FloatArray, faces: IntArray, distances: Callable[[FloatArray], FloatArray]
) -> tuple[FloatArray, IntArray, IntArray]:
    """Split every triangle whose corners are nearest to different parts.

    Args:
        vertices: [m], shape [vertex_count, 3].
        faces: a closed manifold, shape [face_count, 3].
        distances: of points, shape [point_count, 3], to each part [m], shape [point_count,
            part_count].

    Returns:
        Vertices, faces and the part of each face. New vertices lie on edges where the two parts are
        equally near, and in triangles where three parts meet; the surface stays closed.
    """
    label = distances(vertices).argmin(axis=1)
    edges = np.unique(
        np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1),
        axis=0,
    )
    edges = edges[label[edges[:, 0]] != label[edges[:, 1]]]
    a, b = edges.T
    middle = {(int(i), int(j)): len(vertices) + n for n, (i, j) in enumerate(edges)}
    points = [vertices, _crossings(vertices[a], vertices[b], label[a], label[b], distances)]
    kinds = label[faces]
    plain = (kinds[:, 0] == kinds[:, 1]) & (kinds[:, 1] == kinds[:, 2])
    new_faces, new_labels = [*map(tuple, faces[plain].tolist())], kinds[plain, 0].tolist()
    centers: list[FloatArray] = []
    next_vertex = len(vertices) + len(edges)
    for face in faces[~plain].tolist():
        pieces = _split(face, label, middle, next_vertex)
        if len(pieces) > len(face):
            centers.append(_meeting_point(vertices[face], label[face], distances))
            next_vertex += 1
        new_faces += [corners for corners, _ in pieces]
        new_labels += [kind for _, kind in pieces]
    if centers:
        points.append(np.array(centers))
    return (
        np.concatenate(points),
        np.array(new_faces, dtype=np.int64),
        np.array(new_labels, dtype=np.int64),
    )


def _crossings(
    start: FloatArray,
    end: FloatArray,
    one: IntArray,
    other: IntArray,
    distances: Callable[[FloatArray], FloatArray],
) -> FloatArray:
    """Where, on the way from ``start`` to ``end``, part ``other`` becomes nearer than ``one`` [m]."""
    rows = np.arange(len(start))
    low, high = np.zeros(len(start)), np.ones(len(start))
    for _ in range(HALVINGS):
        share = (low + high) / 2.0
        found = distances(start + share[:, None] * (end - start))
        still = found[rows, one] < found[rows, other]
        low, high = np.where(still, share, low), np.where(still, high, share)
    # Not too near the ends, or whoever welds close vertices would close the cut.
    share = np.clip((low + high) / 2.0, 0.03, 0.97)
    return start + share[:, None] * (end - start)


def _meeting_point(
    corners: FloatArray, kinds: IntArray, distances: Callable[[FloatArray], FloatArray]
) -> FloatArray:
    """Where in a triangle the parts nearest to its three corners are most nearly equally near [m], shape [3]."""
    i, j = np.meshgrid(np.arange(1, GRID), np.arange(1, GRID))
    weights = np.stack([i, j, GRID - i - j], axis=-1).reshape(-1, 3)
    points = weights[weights[:, 2] > 0] / GRID @ corners
    return np.asarray(points[np.ptp(distances(points)[:, kinds], axis=1).argmin()])


def _split(
    face: list[int], label: IntArray, middle: dict[tuple[int, int], int], center: int
) -> list[tuple[tuple[int, int, int], int]]:
    kinds = [int(label[v]) for v in face]
    cut = [middle.get((min(p), max(p))) for p in zip(face, face[1:] + face[:1], strict=True)]
    if all(c is not None for c in cut):
        pieces = []
        for i in range(3):
            after, before = cut[i], cut[i - 1]
            pieces += [((face[i], after, center), kinds[i]), ((face[i], center, before), kinds[i])]
        return pieces  # type: ignore[return-value]
    lone = next(i for i in range(3) if kinds[i] != kinds[i - 1] and kinds[i] != kinds[(i + 1) % 3])
    v, after, before = face[lone], cut[lone], cut[lone - 1]
    right, left = face[(lone + 1) % 3], face[lone - 1]
    other = kinds[lone - 1]
    return [
        ((v, after, before), kinds[lone]),
        ((after, right, left), other),
        ((after, left, before), other),
    ]  # type: ignore[list-item]
