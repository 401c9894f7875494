"""Where a part's axis could be: its edges, mid-lines, contacts and round pieces, and the guess."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from enum import IntEnum

import numpy as np

from ...mesh import BoolArray, FloatArray, IntArray
from ..geometric.knobs import SECTORS, goes_round
from .body import Body
from .guess import Guess

#: Corners along one direction of a box, nearer than this share of the part's diagonal, are one.
SAME_PLACE = 0.004
#: Components of a part looked at for roundness, largest first.
MOST_COMPONENTS = 12


class LineSource(IntEnum):
    """How a line was found."""

    EDGE = 0
    CONTACT = 1
    ROUND = 2
    GUESSED = 3


@dataclass(frozen=True)
class Candidates:
    """Motions to weigh, as arrays; ``n`` of them.

    Attributes:
        slides: whether it slides (else it turns), shape [n].
        axis: unit directions, positive values open, shape [n, 3].
        origin: points on the axes [m], shape [n, 3].
        source: a :class:`LineSource` each, shape [n].
        radius: of the round piece on the axis [m], 0 if there is none, shape [n].
    """

    slides: BoolArray
    axis: FloatArray
    origin: FloatArray
    source: IntArray
    radius: FloatArray

    def __len__(self) -> int:
        return len(self.axis)

    def about(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return where points [m] of shape [point_count, 3] are, seen from every axis.

        Returns:
            How far along it [m], shape [n, point_count]; the arms from it to them [m], shape [n,
            point_count, 3].
        """
        offset = points[None] - self.origin[:, None]
        along = np.einsum("nij,nj->ni", offset, self.axis)
        return along, offset - along[..., None] * self.axis[:, None]

    def at(self, rows: IntArray | Sequence[int]) -> Candidates:
        """Return some of them, in that order."""
        return Candidates(*(getattr(self, each.name)[rows] for each in fields(self)))


Line = tuple[FloatArray, FloatArray, LineSource, float]


def find_candidates(body: Body, guess: Guess) -> Candidates:
    """Return every line and direction to weigh, both ways round; the same every time."""
    lines: list[Line] = []
    for frame in body.frames:
        lines += _box_lines(body, frame)
    lines += _contact_lines(body)
    lines += _round_lines(body)
    directions = [row for frame in body.frames for row in frame]
    center = body.own.points.mean(axis=0)
    slides: list[Line] = [(row, center, LineSource.EDGE, 0.0) for row in directions]
    said = guess.direction
    if said is not None:
        where = center if guess.point is None else guess.point
        nearest = directions[int(np.argmax(np.abs(np.array(directions) @ said)))]
        lines += [(row, where, LineSource.GUESSED, 0.0) for row in (said, nearest)]
        slides.append((said, center, LineSource.GUESSED, 0.0))
    lines = _without_twins(lines, SAME_PLACE * body.diagonal)
    slides = _without_twins(slides, np.inf)
    axes, places, sources, radii = zip(*lines, *slides, strict=True)
    axis = np.repeat(axes, 2, axis=0)
    axis[1::2] *= -1.0
    return Candidates(
        slides=np.repeat([False, True], [2 * len(lines), 2 * len(slides)]),
        axis=axis / np.linalg.norm(axis, axis=1, keepdims=True),
        origin=np.repeat(places, 2, axis=0),
        source=np.repeat(np.array(sources, dtype=np.int64), 2),
        radius=np.repeat(np.array(radii, dtype=np.float64), 2),
    )


def _places(body: Body, direction: FloatArray) -> list[float]:
    """Return ends and middle of the part along a direction, and of its slab without handles."""
    along = body.corners @ direction
    low = float(along.min())
    high = float(along.max())
    places = [low, high, (low + high) / 2.0]
    places += body.heavy_planes(direction, low)
    kept: list[float] = []
    for place in places:
        if all(abs(place - other) > SAME_PLACE * body.diagonal for other in kept):
            kept.append(place)
    return kept


def _box_lines(body: Body, frame: FloatArray) -> list[Line]:
    places = [_places(body, direction) for direction in frame]
    lines: list[Line] = []
    for k in range(3):
        a = (k + 1) % 3
        b = (k + 2) % 3
        middle = places[k][2] if len(places[k]) > 2 else places[k][0]
        lines += [
            (frame[k], u * frame[a] + v * frame[b] + middle * frame[k], LineSource.EDGE, 0.0)
            for u in places[a]
            for v in places[b]
        ]
    return lines


def _contact_lines(body: Body) -> list[Line]:
    """Return lines through the middle of what touches, along the frames and the contact."""
    points = body.contact.points
    if len(points) < 3:
        return []
    center = (points.min(axis=0) + points.max(axis=0)) / 2.0
    mean = points.mean(axis=0)
    _, directions = np.linalg.eigh(np.cov((points - mean).T))
    offsets = body.own.points - body.own.points.mean(axis=0)
    _, own = np.linalg.eigh(offsets.T @ offsets)
    places = [(row, center) for frame in body.frames for row in frame]
    places += [(row, mean) for row in (directions[:, 2], *own.T)]
    return [(row, place, LineSource.CONTACT, 0.0) for row, place in places]


def _round_lines(body: Body) -> list[Line]:
    """Return the middles of the part's round pieces, seen along the frames' axes."""
    labels = body.partition.components[body.faces]
    triangles = body.partition.triangles[body.faces]
    ids, counts = np.unique(labels, return_counts=True)
    lines: list[Line] = []
    for label in ids[np.argsort(-counts, kind="stable")][:MOST_COMPONENTS]:
        points = triangles[labels == label].reshape(-1, 3)
        if len(points) < 3 * SECTORS:
            continue
        for frame in body.frames:
            for k in range(3):
                found = _circle(points, frame[(k + 1) % 3], frame[(k + 2) % 3])
                if found is not None:
                    center, radius = found
                    place = center + float(points.mean(axis=0) @ frame[k]) * frame[k]
                    lines.append((frame[k], place, LineSource.ROUND, radius))
    return lines


def _circle(points: FloatArray, u: FloatArray, v: FloatArray) -> tuple[FloatArray, float] | None:
    """Fit centre (in the plane of ``u`` and ``v``) and radius [m] of a circular outline."""
    plane = np.stack([points @ u, points @ v], axis=1)
    low = plane.min(axis=0)
    high = plane.max(axis=0)
    sides = high - low
    if not sides.min() > 0.94 * sides.max() or not sides.min() > 0.0:
        return None
    center = (low + high) / 2.0
    radius = float(sides.mean()) / 2.0
    if not goes_round(plane - center, 0.92 * radius, 1.06 * radius):
        return None
    return center[0] * u + center[1] * v, radius


def _without_twins(lines: list[Line], tolerance: float) -> list[Line]:
    """Keep one line of several within the tolerance [m]; round ones stay round."""
    order = sorted(range(len(lines)), key=lambda i: (lines[i][2] != LineSource.ROUND, i))
    axis = np.array([lines[i][0] for i in order]).reshape(-1, 3)
    origin = np.array([lines[i][1] for i in order]).reshape(-1, 3)
    parallel = np.abs(axis @ axis.T) > 0.9998
    apart = origin[:, None] - origin[None]
    apart -= np.einsum("ijk,jk->ij", apart, axis)[..., None] * axis[None]
    same = parallel & (np.linalg.norm(apart, axis=2) <= tolerance)
    first = np.argmax(same, axis=1)
    return [lines[order[i]] for i in range(len(order)) if first[i] == i]
