"""Convex pieces of matter in cells: cut along planes until each fills little and keeps clear."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from heapq import heappop, heappush
from operator import itemgetter

import numpy as np
import numpy.typing as npt
from scipy import ndimage
from scipy.spatial import ConvexHull, QhullError

from ...asset import Hull
from ...mesh import BoolArray, FloatArray
from ..decompose.convex import hull_of, limit_vertices
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
#: Directions in which the outermost points are taken, of a piece and of a try.
DIRECTIONS = 160
TRIED_DIRECTIONS = 40
#: Cells that must stay free are looked at one by one in boxes of fewer cells than this, else a
#: sample of them.
EXACT_BELOW = 8000
#: A sheet is made so thick [m] if it is flatter than this share of its width, and no sliver of
#: fewer cells.
FOIL_M = 0.003
FLAT = 1e-3
FOIL_CELLS = 2.0
#: Corners of a hull that engines on the GPU take.
MOST_CORNERS = 64


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


@dataclass(frozen=True)
class _Nearby:
    """What cuts of one node are tried with.

    Attributes:
        points: of the surface in its box [m], shape [n, 3].
        centers: of a sample of cells in it that must stay free [m], shape [m, 3]; none where all
            are looked at.
        sizes: the weighted volume of each [m3], shape [m].
    """

    points: FloatArray
    centers: FloatArray
    sizes: FloatArray


def convex_pieces(matter: Matter, most: int) -> tuple[Hull, ...]:
    """Return the hulls that cover the matter, at most ``most``; the worst one is cut first.

    Every piece is the hull of what of the matter lies in a box of cells, so that it cannot leave
    that box: where boxes keep clear of something, so do pieces, exactly.
    """
    trifle = matter.trifle
    waiting: list[tuple[float, int, _Node]] = []
    done: list[_Node] = []
    spans: list[Span] = _islands(matter.solid)
    points = matter.points
    number = 0
    while True:
        for span in spans:
            node = _node(matter, span, points)
            if node is not None and node.waste > trifle:
                number += 1
                heappush(waiting, (-node.waste, number, node))
            elif node is not None:
                done.append(node)
        if not waiting or len(waiting) + len(done) >= most:
            break
        node = heappop(waiting)[2]
        points = node.points
        spans = list(_best_cut(matter, node))
        if not spans:
            done.append(node)
    done += [entry[2] for entry in waiting]
    return tuple(limit_vertices(node.hull, MOST_CORNERS) for node in done)


def _islands(solid: BoolArray) -> list[Span]:
    """Return boxes around what hangs together; one around all of it where these overlap."""
    label, count = ndimage.label(solid)
    if not count:
        return []
    spans = [span for span in ndimage.find_objects(label) if span is not None]
    if count > 1 and not any(_meet(a, b) for i, a in enumerate(spans) for b in spans[:i]):
        return spans
    trimmed = _trimmed(solid, tuple(slice(0, size) for size in solid.shape))
    return [] if trimmed is None else [trimmed]


def _meet(a: Span, b: Span) -> bool:
    return all(p.start < q.stop and q.start < p.stop for p, q in zip(a, b, strict=True))


def _node(matter: Matter, span: Span, points: FloatArray) -> _Node | None:
    trimmed = _trimmed(matter.solid, span)
    if trimmed is None:
        return None
    corners = _corners(matter, trimmed)
    box = _box(matter.lattice, trimmed)
    surface = points[box.holds(points, 1e-9)]
    outermost = _extreme(np.concatenate([corners, surface]), DIRECTIONS)
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
    for thickness in (-FOIL_M, FOIL_M):
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


def _box(lattice: Lattice, span: Span) -> Box:
    ends = zip(lattice.lines, span, strict=True)
    return Box(*np.array([(line[part.start], line[part.stop]) for line, part in ends]).T)


def _corners(matter: Matter, span: Span) -> FloatArray:
    """Return corners of cells that touch the matter and lie within the mesh [m]."""
    touching = any_around(matter.solid[span])
    wide = tuple(slice(max(part.start - 1, 0), part.stop + 1) for part in span)
    outside = any_around(np.pad(~matter.whole[wide], 1, constant_values=True))
    offset = [part.start - other.start + 1 for part, other in zip(span, wide, strict=True)]
    deep = ~outside[
        tuple(slice(at, at + size) for at, size in zip(offset, touching.shape, strict=True))
    ]
    return matter.lattice.corners(np.argwhere(_ends(touching & deep)), span)


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


@lru_cache(maxsize=4)
def _directions(count: int) -> npt.NDArray[np.float32]:
    """Return unit vectors evenly over the sphere, the axes and their diagonals, shape [n, 3]."""
    index = np.arange(count) + 0.5
    height = 1.0 - 2.0 * index / count
    turn = np.pi * (1.0 + np.sqrt(5.0)) * index
    radius = np.sqrt(1.0 - height**2)
    even = np.column_stack([radius * np.cos(turn), radius * np.sin(turn), height])
    signs = np.array(np.meshgrid([-1, 0, 1], [-1, 0, 1], [-1, 0, 1])).reshape(3, -1).T
    signs = signs[np.abs(signs).sum(axis=1) > 0]
    exact = signs / np.linalg.norm(signs, axis=1, keepdims=True)
    return np.concatenate([exact, even]).astype(np.float32)


def _extreme(points: FloatArray, count: int) -> FloatArray:
    """Return the outermost of many points, seen from many directions, in their box's scale."""
    if len(points) <= count:
        return points
    size = np.maximum(np.ptp(points, axis=0), 1e-9)
    scaled = ((points - points.min(axis=0)) / size).astype(np.float32)
    outermost = np.zeros(len(points), dtype=bool)
    outermost[(_directions(count) @ scaled.T).argmax(axis=1)] = True
    return np.asarray(points[outermost])


def _waste(matter: Matter, span: Span, hull: Hull) -> float:
    """Return what a hull fills wrongly [m3]: beyond its matter, and more so what must stay free."""
    volumes = matter.lattice.volumes[span]
    own = float((volumes * matter.solid[span]).sum())
    spare = max(hull.volume - FULLER * own, 0.0)
    return spare + filled(matter.lattice, matter.free, span, hull)


def filled(lattice: Lattice, weights: Weights, span: Span, hull: Hull) -> float:
    """Return the volume of cells within a span that a hull fills, each times its weight [m3].

    Walls thinner than cells may pass between their centres: they fill the cells they cross.
    """
    if not weights[span].any():
        return 0.0
    planes = _within(hull.planes * [1.0, 1.0, 1.0, -1.0], hull.vertices, lattice.step)
    return _filled(lattice, weights, span, planes)


def _filled(lattice: Lattice, weights: Weights, span: Span, planes: FloatArray) -> float:
    wrong = weights[span]
    at = lattice.below(planes, span) & (wrong > 0)
    return float((lattice.volumes[span][at] * wrong[at]).sum())


def _within(planes: FloatArray, corners: FloatArray, step: float) -> FloatArray:
    """Return planes below which a hull fills cells; of one thinner than cells, those it crosses.

    The hull's planes have outward normals and offsets, shape [n, 4], its corners shape [n, 3];
    cells are as large as ``step`` [m].
    """
    middle = corners.mean(axis=0)
    axes = np.linalg.svd(corners - middle, full_matrices=False)[2]
    heights = (corners - middle) @ axes[2]
    sides = planes + np.array([0.0, 0.0, 0.0, REACH_M])
    if np.ptp(heights) >= step:
        return np.asarray(sides)
    flat = ConvexHull(corners @ axes[:2].T).equations
    sides = np.column_stack([flat[:, :2] @ axes[:2], flat[:, 2] + REACH_M])
    at = float(middle @ axes[2]) + 0.5 * (heights.min() + heights.max())
    above = np.append(axes[2], -at - 0.5 * step)
    under = np.append(-axes[2], at - 0.5 * step)
    return np.concatenate([sides, [above, under]])


def _best_cut(matter: Matter, node: _Node) -> tuple[Span, ...]:
    """Return the two halves of that cut after which least is left to be cut; none if none helps."""
    best: tuple[Span, ...] = ()
    least = np.inf
    nearby = _nearby(matter, node.span)
    for axis, plane in _planes(matter, node.span):
        halves = _halves(node.span, axis, plane)
        cost = 0.0
        for half in sorted(halves, key=_cells_in, reverse=True):
            cost += _cost(matter, nearby, half, least - cost)
            if cost >= least:
                break
        else:
            best = halves
            least = cost
    return best


def _cells_in(span: Span) -> int:
    return math.prod(part.stop - part.start for part in span)


def _halves(span: Span, axis: int, plane: int) -> tuple[Span, Span]:
    first = list(span)
    second = list(span)
    first[axis] = slice(span[axis].start, plane)
    second[axis] = slice(plane, span[axis].stop)
    return tuple(first), tuple(second)


def _nearby(matter: Matter, span: Span) -> _Nearby:
    box = _box(matter.lattice, span)
    points = matter.sparse[box.holds(matter.sparse, 1e-9)]
    if _cells_in(span) < EXACT_BELOW:
        # All cells of either half are looked at.
        return _Nearby(points, np.zeros((0, 3)), np.zeros(0))
    centers, sizes = matter.sampled
    inside = box.holds(centers)
    return _Nearby(points, centers[inside], sizes[inside])


def _cost(matter: Matter, nearby: _Nearby, span: Span, most: float) -> float:
    """Estimate the remaining error in some cells: a hull that must be cut again, and its waste.

    A quick estimate: the corners of cells beside the box's own count as its own. From ``most`` on
    it may be less than that: what must stay free is not looked at then.
    """
    trimmed = _trimmed(matter.solid, span)
    if trimmed is None:
        return 0.0
    box = _box(matter.lattice, trimmed)
    corners = tuple(slice(part.start, part.stop + 1) for part in trimmed)
    points = matter.lattice.corners(np.argwhere(_ends(matter.corners[corners])), trimmed)
    points = np.concatenate([points, nearby.points[box.holds(nearby.points, 1e-9)]])
    own = float((matter.lattice.volumes[trimmed] * matter.solid[trimmed]).sum())
    outermost = _extreme(points, TRIED_DIRECTIONS)
    try:
        hull = ConvexHull(outermost)
    except (QhullError, ValueError, IndexError):
        size = own
        # Slivers of a sheet, of which no foil is made, are lost.
        waste = min((each for _, each in _foils(matter, trimmed, outermost)), default=own)
    else:
        size = float(hull.volume)
        waste = max(size - FULLER * own, 0.0)
        if _weighed(waste, size, matter.trifle) < 1.01 * most:
            waste += _blocked(matter, nearby, trimmed, box, hull)
    return _weighed(waste, size, matter.trifle)


def _weighed(waste: float, size: float, trifle: float) -> float:
    """Return what waste counts: all of a hull that must be cut again, and a share of the waste."""
    return TIE * min(waste, size) + (size if waste > trifle else 0.0)


def _blocked(matter: Matter, nearby: _Nearby, span: Span, box: Box, hull: ConvexHull) -> float:
    """Return how much of what must stay free a hull fills [m3], times its weight."""
    planes = _within(hull.equations, hull.points[hull.vertices], matter.lattice.step)
    if _cells_in(span) < EXACT_BELOW:
        return _filled(matter.lattice, matter.free, span, planes)
    inside = box.holds(nearby.centers)
    heights = nearby.centers[inside] @ planes[:, :3].T + planes[:, 3]
    deep = heights.max(axis=1, initial=-np.inf) < 0.0
    return float(nearby.sizes[inside][deep].sum())


def _planes(matter: Matter, span: Span) -> Iterator[tuple[int, int]]:
    """Yield the planes worth trying: where much begins or ends, and the middle; axis and line."""
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
            yield axis, span[axis].start + line
