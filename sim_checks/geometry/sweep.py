"""The deepest overlap of two sets of hulls along a joint's whole path: continuous, not sampled.

Every direction ever found between two hulls bounds their overlap along the *whole* path from above,
because how far a polyhedron reaches along a direction is known in closed form while it turns or
slides. So the path is split into intervals with an upper bound each, the most dangerous interval is
looked at exactly, the direction found there lowers the bounds of all others, and the search ends
when no interval can hold anything worse than the worst seen.
"""

from __future__ import annotations

import heapq
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cache

import numpy as np

from ..description import BoolArray, FloatArray
from .collision import Collider, LookBudget
from .depth import HullOverlap
from .path import Path
from .placing import box_around, box_corners, boxes_near, placed

#: Intervals of the path in which what is far from everything is told.
COARSE_STEPS = 8
#: Far above what rounding does to a box, far below any gap that counts [m].
ROUNDING = 1e-9
#: How far beyond the limit a worst may lie that is taken for one within it [m].
LIMIT_CERTAINTY = 1e-7
#: A search that takes this many times the looks to be certain of its side runs along the limit
#: itself: the ordinary precision has to do.
PATIENCE = 10


@dataclass(frozen=True)
class Candidate:
    """Two hulls that may meet: their indices, and distances at the start.

    Attributes:
        moving, standing: indices.
        rest: depth [m] that is no news (0 where the two do not touch at rest).
        known: direction from the moving to the standing hull, at the path's start, worth trying
            first; ``None`` where none is known.
    """

    moving: int
    standing: int
    rest: float
    known: FloatArray | None = None


@dataclass(frozen=True)
class Worst:
    """The deepest place found.

    Attributes:
        excess: depth beyond rest [m]; negative is the smallest gap, down to the floor that was
            asked for.
        bound: nothing along the path is worse than this [m].
        at: where along the path [rad] or [m] from its start.
        candidate: which two hulls.
        depth: total depth there [m]; negative is a gap.
    """

    excess: float
    bound: float
    at: float
    candidate: Candidate
    depth: float


@dataclass
class _Track:
    """One candidate's intervals, from ``starts`` to ``ends``, with an upper bound each."""

    candidate: Candidate
    starts: FloatArray
    ends: FloatArray
    bounds: FloatArray
    directions: list[tuple[FloatArray, bool]] = field(default_factory=list)


@dataclass(frozen=True)
class Tolerance:
    """When to stop looking.

    Attributes:
        absolute: the worst is found to this [m], or to ``relative`` of itself if that is more.
        relative: share of the worst.
        floor: gaps wider than this are not measured [m].
        limit: deeper than this is a failure [m]: no search ends before it is certain, to
            :data:`LIMIT_CERTAINTY`, on which side it falls.
        looks: exact looks before a search that is past doubt about ``limit`` gives up precision.
        decides: on which side of ``limit`` the worst falls is all that is asked: a search ends at
            the first place beyond it.
    """

    absolute: float = 2e-5
    relative: float = 0.02
    floor: float = 0.005
    limit: float = 0.001
    looks: int = 2000
    decides: bool = False


class Sweep:
    """A path, the hulls that ride on it and the hulls that stand.

    Args:
        path: the motion of moving links, as seen from fixed ones.
        moving: placed where they are at the path's start.
        standing: placed where they are then.
        steps: how many intervals to begin with.
        budget: of the looks that the whole file may take.
    """

    def __init__(
        self,
        path: Path,
        moving: Sequence[Collider],
        standing: Sequence[Collider],
        steps: int,
        budget: LookBudget,
    ) -> None:
        self.path = path
        self.moving = moving
        self.standing = standing
        self.places = np.linspace(0.0, path.length, steps + 1)
        self.looks = 0
        self._budget = budget
        self._start_poses = starts = [collider.pose for collider in moving]
        backwards = path.inverse()
        # Of every hull that comes near another, and of that alone.
        self._orbit = cache(lambda i: path.orbit(placed(moving[i].local.vertices, starts[i])))
        self._swept = cache(lambda i: self._orbit(i).swept_bounds(self.places))
        self._still_orbit = cache(lambda i: backwards.orbit(standing[i].hull.vertices))

    def near(self, floor: float) -> BoolArray:
        """Tell which moving hulls may come within ``floor`` [m] of standing ones."""
        still = np.array([collider.bounds for collider in self.standing]).reshape(-1, 2, 3)
        close = boxes_near(self._reached(), still, floor + ROUNDING)
        for index in np.flatnonzero(close.any(axis=1)).tolist():
            close[index] = boxes_near(box_around([self._swept(index)])[None], still, floor)[0]
        return close

    def _reached(self) -> FloatArray:
        """Return boxes around all that the moving hulls' own swept boxes hold [m], [moving, 2, 3].

        Wider than these, but found for all hulls at once: most are far from everything.
        """
        boxes = np.array([collider.bounds for collider in self.moving]).reshape(-1, 2, 3)
        corners = box_corners(boxes).reshape(-1, 3)
        at = np.linspace(0.0, self.path.length, COARSE_STEPS + 1)
        poses = self.path.poses(at)
        points = corners @ poses[:, :3, :3].transpose(0, 2, 1) + poses[:, None, :3, 3]
        points = points.reshape(len(at), len(boxes), 8, 3)
        # Between two places a point leaves the straight line by an eighth of its acceleration times
        # the square of the step; the finer boxes add as much for theirs.
        steps = at[1] ** 2 + self.places[1] ** 2
        _, acceleration = self.path.limits(corners)
        margin = steps / 8.0 * acceleration.reshape(len(boxes), 8, 1).max(axis=1)
        lowest = points.min(axis=(0, 2)) - margin
        return np.stack([lowest, points.max(axis=(0, 2)) + margin], axis=1)

    def worst(self, candidates: Sequence[Candidate], tolerance: Tolerance) -> Worst | None:
        """Find the worst excess over rest of the candidates; ``None`` if all stay beyond the floor.

        Raises:
            TooManyLooks: the file has taken more than it may.
        """
        followed = (self._track(item, tolerance.floor) for item in candidates)
        tracks = [track for track in followed if track is not None]
        queue = [(-float(track.bounds.max()), index) for index, track in enumerate(tracks)]
        heapq.heapify(queue)
        best: Worst | None = None
        spent = 0
        while queue:
            bound = -queue[0][0]
            if bound <= self._goal(best, tolerance, spent):
                break
            _, index = heapq.heappop(queue)
            found = self._look(tracks[index])
            spent += 1
            if best is None or found.excess > best.excess:
                best = found
            heapq.heappush(queue, (-float(tracks[index].bounds.max()), index))
        self.looks += spent
        if best is None or best.excess < -tolerance.floor:
            return None
        bound = max(best.excess, -queue[0][0]) if queue else best.excess
        return replace(best, bound=bound)

    def place(self, index: int, at: float) -> Collider:
        """Return a moving hull, put where it is at ``at``."""
        collider = self.moving[index]
        collider.place(self.path.pose(at) @ self._start_poses[index])
        return collider

    def _goal(self, best: Worst | None, tolerance: Tolerance, spent: int) -> float:
        """Return the bound at or below which an interval needs no look."""
        if tolerance.decides and spent < PATIENCE * tolerance.looks:
            failed = best is not None and best.excess > tolerance.limit
            return np.inf if failed else tolerance.limit + LIMIT_CERTAINTY
        if best is None:
            return -tolerance.floor
        slack = max(tolerance.absolute, tolerance.relative * abs(best.excess))
        goal = max(best.excess + slack, -tolerance.floor)
        if best.excess > tolerance.limit:
            return goal if spent < tolerance.looks else np.inf
        # Undecided until nothing can lie beyond the limit, however little the worst seen lies below
        # it.
        decided = tolerance.limit + LIMIT_CERTAINTY
        if spent >= PATIENCE * tolerance.looks:
            return max(goal, decided)
        return min(goal, decided) if spent < tolerance.looks else decided

    def _track(self, candidate: Candidate, floor: float) -> _Track | None:
        low = self._swept(candidate.moving)[:, 0]
        high = self._swept(candidate.moving)[:, 1]
        still = self.standing[candidate.standing].bounds
        bounds = np.minimum(high - still[0], still[1] - low).min(axis=1) - candidate.rest
        kept = bounds > -floor
        track = _Track(candidate, self.places[:-1][kept], self.places[1:][kept], bounds[kept])
        if candidate.known is not None:
            self._learn(track, candidate.known, 0.0)
        return track if len(track.bounds) and track.bounds.max() > -floor else None

    def _look(self, track: _Track) -> Worst:
        """Measure exactly in the middle of the worst interval, split it, and lower every bound."""
        self._budget.take()
        index = int(np.argmax(track.bounds))
        middle = 0.5 * (track.starts[index] + track.ends[index])
        mover = self.place(track.candidate.moving, middle)
        found: HullOverlap = mover.stand(self.standing[track.candidate.standing])
        track.starts = np.append(track.starts, middle)
        track.ends = np.append(track.ends, track.ends[index])
        track.ends[index] = middle
        track.bounds = np.append(track.bounds, track.bounds[index])
        halves = np.array([index, len(track.bounds) - 1])
        for direction, riding in track.directions:
            self._lower(track, direction, riding, halves)
        self._learn(track, found.direction, middle)
        excess = found.depth - track.candidate.rest
        return Worst(excess, np.inf, middle, track.candidate, found.depth)

    def _learn(self, track: _Track, direction: FloatArray, at: float) -> None:
        """Use a direction found at one place everywhere: once standing, once moving along."""
        everywhere = np.arange(len(track.bounds))
        riders = [(direction, False)]
        if self.path.turning:
            riders.append((self.path.pose(at)[:3, :3].T @ direction, True))
        for vector, riding in riders:
            track.directions.append((vector, riding))
            self._lower(track, vector, riding, everywhere)

    def _lower(self, track: _Track, direction: FloatArray, riding: bool, rows: np.ndarray) -> None:
        starts = track.starts[rows]
        ends = track.ends[rows]
        mover = self._orbit(track.candidate.moving)
        stander = track.candidate.standing
        if riding:
            # In the moving hull's frame it is the standing one that runs, backwards.
            highest = self._still_orbit(stander).highest(-direction, starts, ends)
            reach = highest + (mover.start @ direction).max()
        else:
            lowest = (self.standing[stander].hull.vertices @ direction).min()
            reach = mover.highest(direction, starts, ends) - lowest
        track.bounds[rows] = np.minimum(track.bounds[rows], reach - track.candidate.rest)
