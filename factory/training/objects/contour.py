"""Marching tetrahedra: the zero surface of a sampled field, always a closed manifold."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ...mesh import FloatArray, IntArray

#: The six tetrahedra of a cube around its main diagonal, as paths of corners (bit 0: x, bit 1: y,
#: bit 2: z).
_TETRAHEDRA = np.array(
    [(0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7), (0, 5, 1, 7)]
)
_OFFSETS = np.array([[corner & 1, corner >> 1 & 1, corner >> 2 & 1] for corner in range(8)])


def contour(field: FloatArray, low: FloatArray, cell: float) -> tuple[FloatArray, IntArray]:
    """The surface where ``field`` is zero, as triangles whose normals point to larger values.

    Args:
        field: values at the corners of a regular grid, positive all along its border, shape [nx,
            ny, nz].
        low: position of ``field[0, 0, 0]`` [m], shape [3].
        cell: distance of neighbouring grid corners [m].

    Returns:
        Vertices [m], shape [vertex_count, 3], and faces, shape [face_count, 3].
    """
    strides = np.array([field.shape[1] * field.shape[2], field.shape[2], 1])
    values = field.reshape(-1)
    inside = field < 0.0
    mixed = _mixed_cells(inside)
    corners = (mixed @ strides)[:, None] + _OFFSETS @ strides
    tets = corners[:, _TETRAHEDRA].reshape(-1, 4)
    edges = _triangle_edges(tets, values[tets] < 0.0)
    pairs = np.sort(edges.reshape(-1, 2), axis=1)
    keys, faces = np.unique(pairs[:, 0] * len(values) + pairs[:, 1], return_inverse=True)
    first, second = keys // len(values), keys % len(values)
    # Kept away from the ends: vertices that coincide would be welded by whoever reads the file.
    share = np.clip(values[first] / (values[first] - values[second]), 0.02, 0.98)[:, None]
    start = np.stack(np.unravel_index(first, field.shape), axis=1)
    end = np.stack(np.unravel_index(second, field.shape), axis=1)
    return low + cell * (start + share * (end - start)), faces.reshape(-1, 3)


def _mixed_cells(inside: npt.NDArray[np.bool_]) -> IntArray:
    count = np.zeros([n - 1 for n in inside.shape], dtype=np.int8)
    for dx, dy, dz in _OFFSETS:
        count += inside[
            dx : dx + count.shape[0], dy : dy + count.shape[1], dz : dz + count.shape[2]
        ]
    return np.argwhere((count > 0) & (count < 8))


def _triangle_edges(tets: IntArray, inside: npt.NDArray[np.bool_]) -> IntArray:
    """Grid edges that carry each triangle's corners, shape [face_count, 3, 2].

    All tetrahedra have the same orientation, so the winding follows from which corners are inside.
    """
    found = []
    count = inside.sum(axis=1)
    for lone in range(4):
        others = [i for i in range(4) if i != lone]
        if lone % 2:
            others = [others[0], others[2], others[1]]
        for chosen, order in (
            ((count == 1) & inside[:, lone], others),
            ((count == 3) & ~inside[:, lone], others[::-1]),
        ):
            t = tets[chosen]
            found.append(np.stack([np.stack([t[:, lone], t[:, i]], axis=1) for i in order], axis=1))
    for a, b, c, d in (
        (0, 1, 2, 3),
        (0, 2, 3, 1),
        (0, 3, 1, 2),
        (2, 3, 0, 1),
        (3, 1, 0, 2),
        (1, 2, 0, 3),
    ):
        t = tets[(count == 2) & inside[:, a] & inside[:, b]]
        ac, ad, bc, bd = (
            np.stack([t[:, i], t[:, j]], axis=1) for i, j in ((a, c), (a, d), (b, c), (b, d))
        )
        found += [np.stack([ac, ad, bd], axis=1), np.stack([ac, bd, bc], axis=1)]
    return np.concatenate(found)
