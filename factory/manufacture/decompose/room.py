"""Where other parts are, at rest and on their way: room that no hull may take."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cache

import numpy as np
from manifold3d import Manifold
from trimesh.bounds import corners

from ...articulation import Articulation
from ...asset import Hull
from ...geometry.rows import distinct_rows
from ...mesh import FloatArray
from ..poses import moved, relative_poses
from .convex import depth_below
from .solids import inside
from .spread import SPREAD, spread_over

#: Poses along each joint that moves another part against this one.
POSES = 13
#: One point is kept in a cube of this side [m].
GRAIN_M = 0.004
#: Most points that are kept.
MOST = 60_000
#: Another part's points so far below a hull's surface are in it [m].
ENTERED_M = 0.001


@dataclass(frozen=True)
class Room:
    """What other parts take.

    Attributes:
        points: on their visible surfaces, in the frame of one part at rest [m], shape [n, 3].
    """

    points: FloatArray

    def inside(self, hull: Hull) -> FloatArray:
        """Return the points that lie in a hull [m], shape [k, 3]."""
        near = _between(self.points, *hull.bounds)
        return near[depth_below(hull, near) > ENTERED_M]

    def entered(self, hull: Hull, sources: Iterable[Hull] = ()) -> bool:
        """Return whether a hull takes room that the hulls which it was made from did not take."""
        found = self.inside(hull)
        for source in sources:
            found = found[depth_below(source, found) <= ENTERED_M / 2.0]
        return bool(len(found))

    def within(self, solid: Manifold) -> bool:
        """Return whether another part reaches into a solid."""
        low, high = np.array(solid.bounding_box()).reshape(2, 3)
        return bool(inside(solid, _between(self.points, low, high)).any())


#: Nobody else's room.
NOWHERE = Room(np.zeros((0, 3)))


def rooms_of(articulation: Articulation) -> Callable[[int], Room]:
    """Return a function from a part's index to the room that others take of it as they pass.

    Each is looked for once.
    """
    points_of = cache(lambda part: spread_over(articulation.part_mesh(part), SPREAD))

    @cache
    def room_of(part: int) -> Room:
        own = articulation.part_mesh(part)
        if not len(own.faces):
            return NOWHERE
        low, high = own.bounds
        found = [NOWHERE.points]
        for other in range(len(articulation.parts)):
            points = NOWHERE.points if other == part else points_of(other)
            if not len(points):
                continue
            box = corners([points.min(axis=0), points.max(axis=0)])
            for pose in relative_poses(articulation, part, other, POSES):
                reach = moved(box, pose)
                if (reach.max(axis=0) > low).all() and (reach.min(axis=0) < high).all():
                    found.append(_between(moved(points, pose), low, high))
        return Room(_thinned(np.concatenate(found)))

    return room_of


def _between(points: FloatArray, low: FloatArray, high: FloatArray) -> FloatArray:
    """Return the points that lie in a box [m], shape [k, 3]."""
    return points[((points > low) & (points < high)).all(axis=1)]


def _thinned(points: FloatArray) -> FloatArray:
    first, _ = distinct_rows(np.floor(points / GRAIN_M).astype(np.int64))
    kept = points[np.sort(first)]
    if len(kept) <= MOST:
        return kept
    return kept[np.sort(np.random.default_rng(0).choice(len(kept), MOST, replace=False))]
