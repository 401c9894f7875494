"""What artists add and leave out: lettering, handles, what nobody sees from outside."""

from __future__ import annotations

from itertools import product

import numpy as np

from asset_factory.factory.mesh import BoolArray, FloatArray

from .labelled import Labelled, joined
from .surfaces import boxes_among

#: Points tried on the surface.
POINTS = 8000
#: Pixels along a picture's side.
PIXELS = 24
#: Depth by which a point may lie behind what is seen in its pixel, as a share of the longest side.
SLACK = 0.02
#: Share of a face's points seen by mistake, through pixels that no nearer point fills.
LEAKS = 0.15
#: A piece counts as hidden if this share of its surface is.
MOSTLY = 0.7
#: How far lettering stands off its ground [m].
STAND_OFF_M = 0.0006
_QUAD = np.array([(0, 1, 2), (0, 2, 3)], dtype=np.int64)
_CORNERS = np.array([(0, 0), (1, 0), (1, 1), (0, 1)])


def lettered(mesh: Labelled, rng: np.random.Generator) -> Labelled:
    """Add a few lines of small quads before, beside or on top of large boxes, of the same part."""
    low, high = mesh.boxes()
    boxes = boxes_among(mesh)
    added = [mesh]
    for _ in range(int(rng.integers(1, 4)) if boxes.any() else 0):
        axis = 1 if rng.random() < 0.8 else int(rng.choice([0, 2]))
        plane = [k for k in range(3) if k != axis]
        weight = np.prod((high - low)[:, plane], axis=1) * boxes
        piece = int(rng.choice(len(weight), p=weight / weight.sum()))
        size = (high - low)[piece, plane]
        letter = size.min() * rng.uniform(0.02, 0.08) * np.array([rng.uniform(0.4, 1.2), 1.0])
        first = low[piece, plane] + rng.uniform(0.05, 0.8, 2) * size
        starts = first + np.outer(np.arange(rng.integers(2, 12)), [1.4 * letter[0], 0.0])
        starts = starts[(starts < high[piece, plane] - letter).all(axis=1)]
        vertices = np.empty((len(starts), 4, 3))
        vertices[:, :, plane] = starts[:, None] + letter * _CORNERS
        ground = low[piece, axis] - STAND_OFF_M if axis == 1 else high[piece, axis] + STAND_OFF_M
        vertices[:, :, axis] = ground
        # Counter-clockwise in the plane is clockwise about y and the other way about x and z:
        # every quad looks away from its ground.
        faces = (_QUAD + 4 * np.arange(len(starts))[:, None, None]).reshape(-1, 3)
        label = np.tile(mesh.piece_labels[piece], (len(faces), 1))
        label[:, 1] = np.repeat(np.arange(len(starts)), 2)
        added.append(Labelled(vertices.reshape(-1, 3), faces, label))
    return joined(added)


def without_handles(mesh: Labelled, rng: np.random.Generator) -> Labelled:
    """Strip half of the moving parts of the small pieces that stick out of their largest."""
    low, high = mesh.boxes()
    areas = np.bincount(mesh.piece, mesh.areas)
    owner = mesh.piece_labels[:, 0]
    dropped = np.zeros(mesh.piece_count, dtype=bool)
    for part in range(1, int(owner.max()) + 1):
        pieces = np.flatnonzero(owner == part)
        if len(pieces) < 2 or rng.random() < 0.5:
            continue
        largest = pieces[areas[pieces].argmax()]
        before = (low[pieces] < low[largest] - 0.004).any(axis=1)
        behind = (high[pieces] > high[largest] + 0.004).any(axis=1)
        small = areas[pieces] < 0.12 * areas[pieces].sum()
        dropped[pieces[(before | behind) & small]] = True
    return mesh.without(dropped[mesh.piece])


def hidden_faces(mesh: Labelled, rng: np.random.Generator) -> BoolArray:
    """Return the faces of which no point is seen from any of 14 directions, shape [face_count].

    Points on the surface are drawn into depth pictures; few of a hidden face's are in front.
    """
    points, face, _ = mesh.sampled(rng.random(POINTS), rng)
    low = points.min(axis=0)
    extents = points.max(axis=0) - low
    points = (points - low - extents / 2.0) / extents.max()
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
    count = len(mesh.faces)
    return np.asarray(np.bincount(face, seen, count) <= LEAKS * np.bincount(face, minlength=count))


def without_hidden(mesh: Labelled, rng: np.random.Generator) -> Labelled:
    """Leave out faces that are hidden from everywhere outside."""
    return mesh.without(hidden_faces(mesh, rng))


def without_hidden_pieces(mesh: Labelled, rng: np.random.Generator) -> Labelled:
    """Leave out pieces that are mostly hidden: an object without its inside."""
    areas = mesh.areas
    hidden = np.bincount(mesh.piece, areas * hidden_faces(mesh, rng))
    mostly = hidden > MOSTLY * np.bincount(mesh.piece, areas)
    return mesh.without(mostly[mesh.piece])


def _directions() -> FloatArray:
    """Return the corners and sides of a cube, aslant, so that none looks along a board."""
    ways = [way for way in product((-1, 0, 1), repeat=3) if np.abs(way).sum() in (1, 3)]
    directions = np.array(ways) + np.array([0.11, 0.07, 0.05])
    return np.asarray(directions / np.linalg.norm(directions, axis=1, keepdims=True))
