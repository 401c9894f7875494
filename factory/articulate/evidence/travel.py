"""Candidates tried out: the part's points moved along each, and what they meet."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...mesh import FloatArray
from .body import Body
from .candidates import Candidates

#: Angles at which a turning part is looked at [rad].
TURNS = np.radians([8.0, 25.0, 55.0, 90.0])
#: Shares of its length at which a sliding part is looked at.
SLIDES = np.array([0.08, 0.25, 0.5, 0.85])


@dataclass(frozen=True)
class Travel:
    """What became of the part's points.

    Attributes:
        hits: share of them that have gone through what stays, by candidate and step, shape [n, 4].
        held: as ``hits``, through what the part hangs on alone.
        out: how many more are outside the box of what stays after step 3, -1 to 1, shape [n].
    """

    hits: FloatArray
    held: FloatArray
    out: FloatArray


def travel(body: Body, some: Candidates) -> Travel:
    """Try out candidates of one kind."""
    slides = bool(some.slides[0])
    points = body.probes.points
    values = np.tile(TURNS, (len(some), 1))
    if slides:
        # Of the part's length that way, or of a fifth of its diagonal.
        length = np.maximum(np.ptp(points @ some.axis.T, axis=0), 0.2 * body.diagonal)
        values = length[:, None] * SLIDES
    hits, held = np.zeros((2, len(some), 4))
    outside = np.zeros(len(some))
    for step in range(4):
        moved, headings, gone = displaced(some, points, values[:, step])
        hits[:, step] = body.grid.hits(moved, headings, gone).mean(axis=1)
        held[:, step] = (
            body.holder.hits(moved, headings, gone).mean(axis=1) if body.crowded else hits[:, step]
        )
        if step == 2:
            outside = _outside(body, moved) - _outside(body, points[None])
    return Travel(hits, held, outside)


def displaced(
    some: Candidates, points: FloatArray, values: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the points moved along candidates of one kind.

    Args:
        some: ``n`` of one kind.
        points: [m], shape [point_count, 3].
        values: one for each candidate [rad] or [m], shape [n].

    Returns:
        Positions [m] and unit headings, shape [n, point_count, 3]; path lengths [m], shape [n,
        point_count].
    """
    shape = (len(some), len(points), 3)
    if some.slides[0]:
        moved = points[None] + (values[:, None] * some.axis)[:, None]
        gone = np.broadcast_to(np.abs(values)[:, None], shape[:2])
        return moved, np.broadcast_to(some.axis[:, None], shape), gone
    along, across = some.about(points)
    turned = np.cross(some.axis[:, None], across)
    cos = np.cos(values)[:, None, None]
    sin = np.sin(values)[:, None, None]
    radius = np.sqrt(np.einsum("nij,nij->ni", across, across))
    headings = (cos * turned - sin * across) / np.maximum(radius, 1e-12)[..., None]
    foot = some.origin[:, None] + along[..., None] * some.axis[:, None]
    moved = foot + cos * across + sin * turned
    return moved, headings, radius * np.abs(values)[:, None]


def _outside(body: Body, points: FloatArray) -> FloatArray:
    """Return the share of points outside the box of what stays, in the level frame, shape [n]."""
    rest = body.grid.surfels.points
    if not len(rest):
        return np.ones(len(points))
    turned = rest @ body.partition.level.T
    margin = 0.01 * body.diagonal
    low = turned.min(axis=0) - margin
    high = turned.max(axis=0) + margin
    here = points @ body.partition.level.T
    return np.asarray(((here < low) | (here > high)).any(axis=2).mean(axis=1))
