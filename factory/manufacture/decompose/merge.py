"""Neighbouring hulls joined into one where what fills up between them is within the error."""

from __future__ import annotations

import heapq
from dataclasses import dataclass

import numpy as np
from manifold3d import Manifold

from ...asset import Hull
from ...geometry.triangles import areas_of
from ...mesh import FloatArray
from .convex import hull_of
from .pockets import fills_little
from .room import NOWHERE, Room
from .solids import manifold_of_hull

#: More hulls than this are many: even exact ones are joined where that fills little, and all are
#: first joined in two halves of space each, so that the pairs stay few.
TOGETHER = 24
#: Pairs that might be joined, before the rest stay as they are: a count, not a clock, so that the
#: same hulls always end the same.
MOST_LOOKS = 6000


@dataclass
class _Cluster:
    hull: Hull
    sources: Manifold
    low: FloatArray
    high: FloatArray

    @classmethod
    def of(cls, hull: Hull, sources: Manifold) -> _Cluster:
        return cls(hull, sources, hull.vertices.min(axis=0), hull.vertices.max(axis=0))


def merge(
    hulls: list[Hull], error_m: float, slot_m: float | None = None, room: Room = NOWHERE
) -> list[Hull]:
    """Join hulls where that fills little.

    Pairs are joined, the one that fills least first, as long as the joined hull's surface stays
    within ``error_m`` [m] of the hulls it was made from, see ``fills_little``, and takes none of a
    room that these do not take. Slots up to ``slot_m`` wide may be filled [m]; ``None``: twice the
    error.
    """
    start = [_Cluster.of(hull, manifold_of_hull(hull)) for hull in hulls]
    return [cluster.hull for cluster in _halve_and_join(start, _Yardstick(error_m, slot_m, room))]


@dataclass
class _Yardstick:
    """The limits, see :func:`merge`, and how many more pairs may be offered."""

    error_m: float
    slot_m: float | None
    room: Room
    looks: int = MOST_LOOKS


def _halve_and_join(clusters: list[_Cluster], yardstick: _Yardstick) -> list[_Cluster]:
    if len(clusters) <= TOGETHER:
        return _join_greedily(clusters, [], yardstick)
    middles = np.array([(c.low + c.high) / 2.0 for c in clusters])
    order = np.argsort(middles[:, np.ptp(middles, axis=0).argmax()], kind="stable").tolist()
    half = len(order) // 2
    left = _halve_and_join([clusters[i] for i in order[:half]], yardstick)
    right = _halve_and_join([clusters[i] for i in order[half:]], yardstick)
    return _join_greedily(left, right, yardstick)


def _join_greedily(
    left: list[_Cluster], right: list[_Cluster], yardstick: _Yardstick
) -> list[_Cluster]:
    """Join within ``left`` if ``right`` is empty; else only across, as each side is done."""
    clusters = dict(enumerate([*left, *right]))
    queue: list[tuple[float, int, int]] = []
    for i in range(len(left)):
        others = range(len(left), len(clusters)) if right else range(i + 1, len(left))
        _offer(queue, clusters, i, list(others), yardstick)
    fresh = len(clusters)
    while queue:
        _, i, j = heapq.heappop(queue)
        if i not in clusters or j not in clusters:
            continue
        # Only now: most pairs that might be joined never are, since one of them is joined before.
        joined = _joined_as_allowed(clusters[i], clusters[j], yardstick)
        if joined is None:
            continue
        del clusters[i], clusters[j]
        clusters[fresh] = joined
        _offer(queue, clusters, fresh, [k for k in clusters if k != fresh], yardstick)
        fresh += 1
    return list(clusters.values())


def _joined(first: _Cluster, second: _Cluster) -> Hull | None:
    return hull_of(np.concatenate([first.hull.vertices, second.hull.vertices]))


def _offer(
    queue: list[tuple[float, int, int]],
    clusters: dict[int, _Cluster],
    i: int,
    others: list[int],
    yardstick: _Yardstick,
) -> None:
    if not others:
        return
    one = clusters[i]
    low = np.array([clusters[j].low for j in others])
    high = np.array([clusters[j].high for j in others])
    error_m = yardstick.error_m
    near = (low <= one.high + error_m) & (high >= one.low - error_m)
    for j in np.flatnonzero(near.all(axis=1)).tolist():
        cost = _cost(one, clusters[others[j]], yardstick)
        if cost < np.inf:
            heapq.heappush(queue, (cost, min(i, others[j]), max(i, others[j])))


def _cost(first: _Cluster, second: _Cluster, yardstick: _Yardstick) -> float:
    """Return the volume that joining two clusters fills [m3]; infinite where that is soon wrong."""
    error_m = yardstick.error_m
    hull = _joined(first, second) if yardstick.looks > 0 else None
    if hull is None:
        return np.inf
    corners = hull.vertices[hull.faces]
    area = float(areas_of(corners).sum())
    filled = hull.volume - first.hull.volume - second.hull.volume
    if filled > error_m * area or _gap(first, second, corners.mean(axis=1)) > error_m:
        return np.inf
    yardstick.looks -= 1
    return max(filled, 0.0)


def _joined_as_allowed(first: _Cluster, second: _Cluster, yardstick: _Yardstick) -> _Cluster | None:
    """Return two clusters as one; ``None`` if its hull fills what must stay open."""
    hull = _joined(first, second)
    if hull is None or yardstick.room.entered(hull, (first.hull, second.hull)):
        return None
    sources = first.sources + second.sources
    if not fills_little(hull, sources, yardstick.error_m, yardstick.slot_m):
        return None
    return _Cluster.of(hull, sources)


def _gap(first: _Cluster, second: _Cluster, points: FloatArray) -> float:
    """Return at most the largest distance of points from both clusters [m]: a cheap early exit."""
    planes = (first.hull.planes, second.hull.planes)
    outside = [(points @ each[:, :3].T - each[:, 3]).max(axis=1) for each in planes]
    return float(np.minimum(*outside).max())
