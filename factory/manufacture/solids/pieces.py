"""Convex pieces of matter in cells: cut along planes until each fills little and keeps clear."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from heapq import heappop, heappush
from operator import itemgetter

import numpy as np
import numpy.typing as npt
from scipy.spatial import ConvexHull

from asset_factory.sim_checks.geometry.placing import spread_directions

from ...asset import Hull
from ...config import DecomposeConfig
from ...mesh import BoolArray, FloatArray
from ..decompose.convex import hull_of, limit_vertices
from ..separate.clip import SHEET_M
from .box import Box
from .lattice import Lattice, Span
from .matter import Matter, Weights, any_around

#: A piece may be this much fuller than its matter.
FULLER = 1.35
#: Pieces may reach this far into what must stay free [m]; what is cut exactly needs none.
REACH_M = 0.001
#: Planes tried across each axis.
PLANES = 4
#: How much waste counts beside what must be cut again: it tells cuts that are alike apart.
TIE = 0.1
#: What is flatter than this share of its width is made as thick as a sheet, but no sliver of fewer
#: cells.
FLAT = 1e-3
FOIL_CELLS = 2.0
#: Corners of a hull that engines on the GPU take.
MOST_CORNERS = DecomposeConfig.max_vertices


@dataclass(frozen=True)
class _Node:
    """Cells between planes.

    Attributes:
        span: the cells.
        points: of the matter's surface in them [m], shape [n, 3].
        hull: of the matter in them.
        waste: what it fills wrongly [m3].
    """

    span: Span
    points: FloatArray
    hull: Hull
    waste: float


def convex_pieces(matter: Matter, most: int) -> tuple[Hull, ...]:
    """Return the hulls that cover the matter, at most ``most``; the worst one is cut first.

    Every piece is the hull of what of the matter lies in a box of cells, so that it cannot leave
    that box: where boxes keep clear of something, so do pieces, exactly.
    """
    trifle = matter.trifle
    waiting: list[tuple[float, int, _Node]] = []
    done: list[_Node] = []
    everywhere = tuple(slice(0, size) for size in matter.solid.shape)
    fresh = [_node(matter, everywhere, matter.points)]
    number = 0
    while True:
        for node in filter(None, fresh):
            if node.waste > trifle:
                number += 1
                heappush(waiting, (-node.waste, number, node))
            else:
                done.append(node)
        if not waiting or len(waiting) + len(done) >= most:
            break
        node = heappop(waiting)[2]
        fresh = _best_cut(matter, node)
        if not fresh:
            done.append(node)
    done += [entry[2] for entry in waiting]
    return tuple(limit_vertices(node.hull, MOST_CORNERS) for node in done)


def _node(matter: Matter, span: Span, points: FloatArray) -> _Node | None:
    trimmed = _trimmed(matter.solid, span)
    if trimmed is None:
        return None
    corners = _corners(matter, trimmed)
    ends = zip(matter.lattice.lines, trimmed, strict=True)
    box = Box(*np.array([(line[part.start], line[part.stop]) for line, part in ends]).T)
    surface = points[box.holds(points, 1e-9)]
    outermost = _extreme(np.concatenate([corners, surface]))
    hull = hull_of(outermost)
    if hull is not None:
        return _Node(trimmed, surface, hull, _waste(matter, trimmed, hull))
    foils = _foils(matter, trimmed, outermost)
    hull, waste = min(foils, key=itemgetter(1), default=(None, 0.0))
    return None if hull is None else _Node(trimmed, surface, hull, waste)


def _foils(matter: Matter, span: Span, points: FloatArray) -> Iterator[tuple[Hull, float]]:
    """Yield a flat sheet, made thick to either side, and what that fills wrongly [m3]."""
    if len(points) < 3:
        return
    _, spread, axes = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)
    wide = np.ptp(points @ axes.T, axis=0)[1]
    if spread[2] > FLAT * spread[1] or wide < FOIL_CELLS * matter.lattice.step:
        return
    for thickness in (-SHEET_M, SHEET_M):
        foil = hull_of(np.concatenate([points, points + thickness * axes[2]]))
        if foil is not None:
            yield foil, _waste(matter, span, foil)


def _trimmed(solid: BoolArray, span: Span) -> Span | None:
    trimmed = list(span)
    for axis in (0, 1, 2):
        across = tuple(other for other in range(3) if other != axis)
        filled_at = np.flatnonzero(solid[tuple(trimmed)].any(axis=across))
        if not len(filled_at):
            return None
        start = span[axis].start
        trimmed[axis] = slice(start + int(filled_at[0]), start + int(filled_at[-1]) + 1)
    return tuple(trimmed)


def _corners(matter: Matter, span: Span) -> FloatArray:
    """Return corners of cells that touch the matter and lie within the mesh [m]."""
    deep = matter.deep[tuple(slice(part.start, part.stop + 1) for part in span)]
    touching = any_around(matter.solid[span]) & deep
    at = np.argwhere(_ends(touching)) + [part.start for part in span]
    return np.column_stack([line[at[:, axis]] for axis, line in enumerate(matter.lattice.lines)])


def _ends(corners: BoolArray) -> BoolArray:
    """Return the first and last corner of each row along the longest axis; others lie between."""
    axis = int(np.argmax(corners.shape))
    rows = np.ascontiguousarray(np.moveaxis(corners, axis, -1))
    ends = np.zeros_like(rows)
    for forward, marked in ((rows, ends), (rows[..., ::-1], ends[..., ::-1])):
        first = forward.argmax(axis=-1, keepdims=True)
        np.put_along_axis(marked, first, True, axis=-1)
    # A row without corners has no first one.
    return np.asarray(np.moveaxis(ends & rows, -1, axis))


@cache
def _directions() -> npt.NDArray[np.float32]:
    """Return unit vectors evenly over the sphere, the axes and their diagonals, shape [n, 3]."""
    signs = np.array(np.meshgrid([-1, 0, 1], [-1, 0, 1], [-1, 0, 1])).reshape(3, -1).T
    signs = signs[np.abs(signs).sum(axis=1) > 0]
    exact = signs / np.linalg.norm(signs, axis=1, keepdims=True)
    return np.concatenate([exact, spread_directions(MOST_CORNERS)]).astype(np.float32)


def _extreme(points: FloatArray) -> FloatArray:
    """Return the outermost of many points, seen from many directions, in their box's scale."""
    if len(points) <= MOST_CORNERS:
        return points
    size = np.maximum(np.ptp(points, axis=0), 1e-9)
    scaled = ((points - points.min(axis=0)) / size).astype(np.float32)
    outermost = np.zeros(len(points), dtype=bool)
    outermost[(_directions() @ scaled.T).argmax(axis=1)] = True
    return np.asarray(points[outermost])


def _waste(matter: Matter, span: Span, hull: Hull) -> float:
    """Return what a hull fills wrongly [m3]: beyond its matter, and more so what must stay free."""
    spare = max(hull.volume - FULLER * matter.volume(span), 0.0)
    return spare + filled(matter.lattice, matter.free, span, hull)


def filled(lattice: Lattice, weights: Weights, span: Span, hull: Hull) -> float:
    """Return the volume of cells within a span that a hull fills, each times its weight [m3].

    Walls thinner than cells may pass between their centres: they fill the cells they cross.
    """
    wrong = weights[span]
    if not wrong.any():
        return 0.0
    at = lattice.below(_within(hull, lattice.step), span) & (wrong > 0)
    return float((lattice.volumes[span][at] * wrong[at]).sum())


def _within(hull: Hull, step: float) -> FloatArray:
    """Return planes below which a hull fills cells; of one thinner than cells, those it crosses.

    As of :meth:`~.lattice.Lattice.below`, shape [n, 4]; cells are as large as ``step`` [m].
    """
    corners = hull.vertices
    middle = corners.mean(axis=0)
    axes = np.linalg.svd(corners - middle, full_matrices=False)[2]
    heights = (corners - middle) @ axes[2]
    if np.ptp(heights) >= step:
        return np.asarray(hull.planes * [1.0, 1.0, 1.0, -1.0] + [0.0, 0.0, 0.0, REACH_M])
    flat = ConvexHull(corners @ axes[:2].T).equations
    sides = np.column_stack([flat[:, :2] @ axes[:2], flat[:, 2] + REACH_M])
    at = float(middle @ axes[2]) + 0.5 * (heights.min() + heights.max())
    above = np.append(axes[2], -at - 0.5 * step)
    under = np.append(-axes[2], at - 0.5 * step)
    return np.concatenate([sides, [above, under]])


def _best_cut(matter: Matter, node: _Node) -> list[_Node | None]:
    """Return the two halves of that cut after which least is left to be cut; none if none helps."""
    best: list[_Node | None] = []
    least = np.inf
    for spans in _halves(matter, node.span):
        halves = []
        cost = 0.0
        for span in spans:
            halves.append(_node(matter, span, node.points))
            cost += _cost(matter, span, halves[-1])
            if cost >= least:
                break
        else:
            best = halves
            least = cost
    return best


def _cost(matter: Matter, span: Span, node: _Node | None) -> float:
    """Return the volume left to be cut [m3]: a hull that must be cut again, and a share of waste.

    Slivers of a sheet, of which no foil is made, are lost.
    """
    size = waste = matter.volume(span)
    if node is not None:
        size = node.hull.volume
        waste = node.waste
    return TIE * min(waste, size) + (size if waste > matter.trifle else 0.0)


def _halves(matter: Matter, span: Span) -> Iterator[tuple[Span, Span]]:
    """Yield both sides of the planes worth trying: where much begins or ends, and the middle."""
    for axis in range(3):
        length = span[axis].stop - span[axis].start
        if length < 2:
            continue
        across = tuple(other for other in range(3) if other != axis)
        lines = {length // 2}
        for cells, count in ((matter.free, PLANES), (matter.solid, PLANES - 2)):
            change = np.abs(np.diff(cells[span].sum(axis=across).astype(np.int64)))
            order = np.argsort(-change, kind="stable")[:count]
            lines |= {int(at) + 1 for at in order if change[at] > 0}
        for line in sorted(lines):
            before = list(span)
            behind = list(span)
            before[axis] = slice(span[axis].start, span[axis].start + line)
            behind[axis] = slice(span[axis].start + line, span[axis].stop)
            yield tuple(before), tuple(behind)
