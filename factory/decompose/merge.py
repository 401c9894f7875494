"""Neighbouring hulls joined into one where what fills up between them is within the error."""

from __future__ import annotations

import heapq
from dataclasses import dataclass
from functools import cache

import numpy as np

from ..asset import Hull
from ..mesh.mesh import FloatArray
from .convex import hull_of, planes_of

#: Rows of sample points on one face of a joined hull, at most.
MOST_STEPS = 12
#: More hulls than this are first merged in two halves of space each, so that the pairs stay few.
TOGETHER = 24


@dataclass
class _Cluster:
    hull: Hull
    sources: list[FloatArray]
    low: FloatArray
    high: FloatArray

    @classmethod
    def of(cls, hull: Hull, sources: list[FloatArray]) -> _Cluster:
        return cls(hull, sources, hull.vertices.min(axis=0), hull.vertices.max(axis=0))


def merge(hulls: list[Hull], error_m: float) -> list[Hull]:
    """Fewer hulls over the same geometry.

    Pairs are joined, cheapest first, as long as every point on the joined hull's surface lies within ``error_m``
    of one of the hulls it was made from. What is filled is therefore never wider than twice that.

    Args:
        hulls: convex pieces [m].
        error_m: how far a joined hull's surface may be from its sources [m].
    """
    start = [_Cluster.of(hull, [planes_of(hull)]) for hull in hulls]
    return [cluster.hull for cluster in _halve_and_join(start, error_m)]


def _halve_and_join(clusters: list[_Cluster], error_m: float) -> list[_Cluster]:
    if len(clusters) > TOGETHER:
        middles = np.array([(c.low + c.high) / 2.0 for c in clusters])
        order = np.argsort(middles[:, np.ptp(middles, axis=0).argmax()], kind="stable").tolist()
        half = len(order) // 2
        clusters = [
            *_halve_and_join([clusters[i] for i in order[:half]], error_m),
            *_halve_and_join([clusters[i] for i in order[half:]], error_m),
        ]
    return _join_greedily(dict(enumerate(clusters)), error_m)


def _join_greedily(clusters: dict[int, _Cluster], error_m: float) -> list[_Cluster]:
    queue: list[tuple[float, int, int]] = []
    for i in clusters:
        _offer(queue, clusters, i, [j for j in clusters if j > i], error_m)
    fresh = len(clusters)
    while queue:
        _, i, j = heapq.heappop(queue)
        if i not in clusters or j not in clusters:
            continue
        first, second = clusters.pop(i), clusters.pop(j)
        hull = _joined(first, second)
        if hull is None:
            clusters |= {i: first, j: second}
            continue
        clusters[fresh] = _Cluster.of(hull, first.sources + second.sources)
        _offer(queue, clusters, fresh, [k for k in clusters if k != fresh], error_m)
        fresh += 1
    return list(clusters.values())


def _joined(first: _Cluster, second: _Cluster) -> Hull | None:
    return hull_of(np.concatenate([first.hull.vertices, second.hull.vertices]))


def _offer(
    queue: list[tuple[float, int, int]], clusters: dict[int, _Cluster], i: int, others: list[int], error_m: float
) -> None:
    if not others:
        return
    one = clusters[i]
    low = np.array([clusters[j].low for j in others])
    high = np.array([clusters[j].high for j in others])
    near = ((low <= one.high + error_m) & (high >= one.low - error_m)).all(axis=1)
    for j in np.flatnonzero(near).tolist():
        cost = _cost(one, clusters[others[j]], error_m)
        if cost <= error_m:
            heapq.heappush(queue, (cost, min(i, others[j]), max(i, others[j])))


def _cost(first: _Cluster, second: _Cluster, error_m: float) -> float:
    """Largest distance of the joined hull's surface from its sources [m]; infinite where clearly too far."""
    hull = _joined(first, second)
    if hull is None:
        return np.inf
    corners = hull.vertices[hull.faces]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2.0
    if hull.volume - first.hull.volume - second.hull.volume > 2.0 * error_m * float(area.sum()):
        return np.inf
    points = _samples(corners, area, error_m)
    distance = np.full(len(points), np.inf)
    for planes in first.sources + second.sources:
        np.minimum(distance, (points @ planes[:, :3].T - planes[:, 3]).max(axis=1), out=distance)
    return float(distance.max())


def _samples(corners: FloatArray, area: FloatArray, error_m: float) -> FloatArray:
    """Regular grids on triangles, about two errors' width apart, the centroid at the least, shape [n, 3]."""
    steps = np.clip(np.sqrt(area) / (2.0 * error_m), 1, MOST_STEPS).astype(np.int64)
    return np.concatenate(
        [np.einsum("sc,tcx->tsx", _grid(int(n)), corners[steps == n]).reshape(-1, 3) for n in np.unique(steps)]
    )


@cache
def _grid(steps: int) -> FloatArray:
    """Barycentric coordinates of points spread over a triangle, shape [steps (steps + 1) / 2, 3]."""
    i, j = np.indices((steps, steps)).reshape(2, -1)
    inside = i + j < steps
    u, v = (i[inside] + 1 / 3) / steps, (j[inside] + 1 / 3) / steps
    return np.column_stack([1.0 - u - v, u, v])
