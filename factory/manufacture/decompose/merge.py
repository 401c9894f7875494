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


@dataclass(frozen=True)
class _Cluster:
    """Hulls joined to one, and the solids that it was made from."""

    hull: Hull
    sources: Manifold


def merge(
    hulls: list[Hull], error_m: float, slot_m: float | None = None, room: Room = NOWHERE
) -> list[Hull]:
    """Join hulls where that fills little.

    Pairs are joined, the one that fills least first, as long as the joined hull's surface stays
    within ``error_m`` [m] of the hulls it was made from, see ``fills_little``, and takes none of a
    room that these do not take. Slots up to ``slot_m`` wide may be filled [m]; ``None``: twice the
    error.
    """
    clusters = [_Cluster(hull, manifold_of_hull(hull)) for hull in hulls]
    joining = _Joining(error_m, 2.0 * error_m if slot_m is None else slot_m, room)
    return [cluster.hull for cluster in joining.halve_and_join(clusters)]


@dataclass
class _Joining:
    """The limits, see :func:`merge`, and how many more pairs may be offered."""

    error_m: float
    slot_m: float
    room: Room
    looks: int = MOST_LOOKS

    def halve_and_join(self, clusters: list[_Cluster]) -> list[_Cluster]:
        """Join what may be joined, of many first within two halves of space each."""
        if len(clusters) <= TOGETHER:
            return self._join_greedily(clusters, [])
        middles = np.array([cluster.hull.bounds.mean(axis=0) for cluster in clusters])
        order = np.argsort(middles[:, np.ptp(middles, axis=0).argmax()], kind="stable").tolist()
        half = len(order) // 2
        left = self.halve_and_join([clusters[i] for i in order[:half]])
        right = self.halve_and_join([clusters[i] for i in order[half:]])
        return self._join_greedily(left, right)

    def _join_greedily(self, left: list[_Cluster], right: list[_Cluster]) -> list[_Cluster]:
        """Join within ``left`` if ``right`` is empty; else only across, as each side is done."""
        clusters = dict(enumerate([*left, *right]))
        queue: list[tuple[float, int, int]] = []
        for i in range(len(left)):
            others = range(len(left), len(clusters)) if right else range(i + 1, len(left))
            self._offer(queue, clusters, i, list(others))
        fresh = len(clusters)
        while queue:
            _, i, j = heapq.heappop(queue)
            if i not in clusters or j not in clusters:
                continue
            # Only now: most pairs that might be joined never are, since one of them is joined
            # before.
            joined = self._joined_as_allowed(clusters[i], clusters[j])
            if joined is None:
                continue
            del clusters[i], clusters[j]
            clusters[fresh] = joined
            self._offer(queue, clusters, fresh, [k for k in clusters if k != fresh])
            fresh += 1
        return list(clusters.values())

    def _offer(
        self,
        queue: list[tuple[float, int, int]],
        clusters: dict[int, _Cluster],
        i: int,
        others: list[int],
    ) -> None:
        if not others:
            return
        low, high = clusters[i].hull.bounds
        boxes = np.array([clusters[j].hull.bounds for j in others])
        near = (boxes[:, 0] <= high + self.error_m) & (boxes[:, 1] >= low - self.error_m)
        for j in np.flatnonzero(near.all(axis=1)).tolist():
            cost = self._cost(clusters[i], clusters[others[j]])
            if cost < np.inf:
                heapq.heappush(queue, (cost, min(i, others[j]), max(i, others[j])))

    def _cost(self, first: _Cluster, second: _Cluster) -> float:
        """Return the volume that joining two fills [m3]; infinite where that is soon wrong."""
        hull = _joined(first, second) if self.looks > 0 else None
        if hull is None:
            return np.inf
        corners = hull.vertices[hull.faces]
        area = float(areas_of(corners).sum())
        filled = hull.volume - first.hull.volume - second.hull.volume
        too_much = filled > self.error_m * area
        if too_much or _gap(first, second, corners.mean(axis=1)) > self.error_m:
            return np.inf
        self.looks -= 1
        return max(filled, 0.0)

    def _joined_as_allowed(self, first: _Cluster, second: _Cluster) -> _Cluster | None:
        """Return two clusters as one; ``None`` if its hull fills what must stay open."""
        hull = _joined(first, second)
        if hull is None or self.room.entered(hull, (first.hull, second.hull)):
            return None
        sources = first.sources + second.sources
        little = fills_little(hull, sources, self.error_m, self.slot_m)
        return _Cluster(hull, sources) if little else None


def _joined(first: _Cluster, second: _Cluster) -> Hull | None:
    return hull_of(np.concatenate([first.hull.vertices, second.hull.vertices]))


def _gap(first: _Cluster, second: _Cluster, points: FloatArray) -> float:
    """Return at most the largest distance of points from both clusters [m]: a cheap early exit."""
    planes = (first.hull.planes, second.hull.planes)
    outside = [(points @ each[:, :3].T - each[:, 3]).max(axis=1) for each in planes]
    return float(np.minimum(*outside).max())
