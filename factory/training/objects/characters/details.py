"""Small things that artists add and leave out: lettering, buttons, handles."""

from __future__ import annotations

import numpy as np

from .bevelled import boxes_among
from .labelled import Labelled, joined

#: How far lettering stands off its ground [m].
STAND_OFF_M = 0.0006
_QUAD = np.array([(0, 1, 2), (0, 2, 3)], dtype=np.int64)


def lettered(mesh: Labelled, rng: np.random.Generator, lines: int = 3) -> Labelled:
    """Lines of small quads in front, at the side or on top of large boxes: lettering and buttons of the same part."""
    low, high = mesh.boxes()
    extents = high - low
    owner, material = np.zeros((2, mesh.piece_count), dtype=np.int64)
    owner[mesh.piece], material[mesh.piece] = mesh.part, mesh.material
    boxes = boxes_among(mesh)
    if not boxes.any():
        return mesh
    added = [mesh]
    for _ in range(int(rng.integers(1, lines + 1))):
        axis = 1 if rng.random() < 0.8 else int(rng.choice([0, 2]))
        u, v = [k for k in range(3) if k != axis]
        weight = extents[:, u] * extents[:, v] * boxes
        piece = int(rng.choice(len(weight), p=weight / weight.sum()))
        size = np.array([extents[piece, u], extents[piece, v]])
        count = int(rng.integers(2, 12))
        letter = size.min() * rng.uniform(0.02, 0.08) * np.array([rng.uniform(0.4, 1.2), 1.0])
        place = rng.uniform(0.05, 0.8, 2) * size + np.array([low[piece, u], low[piece, v]])
        reach = np.array([high[piece, u], high[piece, v]]) - letter
        starts = place + np.outer(np.arange(count), [1.4 * letter[0], 0.0])
        starts = starts[(starts < reach).all(axis=1)]
        if not len(starts):
            continue
        vertices = np.empty((len(starts), 4, 3))
        vertices[:, :, [u, v]] = starts[:, None] + letter * np.array(
            [(0, 0), (1, 0), (1, 1), (0, 1)]
        )
        vertices[:, :, axis] = (
            low[piece, axis] - STAND_OFF_M if axis == 1 else high[piece, axis] + STAND_OFF_M
        )
        # From u to v is clockwise about y and the other way about x and z: every quad looks away
        # from its ground.
        faces = (_QUAD + 4 * np.arange(len(starts))[:, None, None]).reshape(-1, 3)
        number = np.repeat(np.arange(len(starts)), 2)
        added.append(
            Labelled(
                vertices.reshape(-1, 3),
                faces,
                np.full(len(faces), owner[piece]),
                number,
                np.full(len(faces), material[piece]),
            )
        )
    return joined(added)


def without_handles(mesh: Labelled, rng: np.random.Generator) -> Labelled:
    """Moving parts without the small pieces that stick out of their largest; each part with probability 1/2."""
    low, high = mesh.boxes()
    areas = np.bincount(mesh.piece, mesh.areas)
    owner = mesh.part_of_piece()
    dropped = np.zeros(mesh.piece_count, dtype=bool)
    for part in range(1, int(owner.max()) + 1):
        pieces = np.flatnonzero(owner == part)
        if len(pieces) < 2 or rng.random() < 0.5:
            continue
        largest = pieces[areas[pieces].argmax()]
        out = (low[pieces] < low[largest] - 0.004).any(axis=1) | (
            high[pieces] > high[largest] + 0.004
        ).any(axis=1)
        small = areas[pieces] < 0.12 * areas[pieces].sum()
        dropped[pieces[out & small]] = True
    return mesh.without(dropped[mesh.piece])
