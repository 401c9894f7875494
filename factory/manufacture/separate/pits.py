"""A pit in what holds a knob, a stem or a button: as large as what turns or slides in it.

Planes cut off everything on one side, so a part deep in a solid body would vanish. Nothing
of the body is seen where a knob stands in it; there a hole costs nothing but volume.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from manifold3d import Manifold

from ...articulation import Joint
from ...asset import Hull
from ...mesh import FloatArray
from ..decompose.convex import hull_of
from ..decompose.solids import manifold_of_hull, volume_within
from ..poses import moved
from .along import Sides, hull_depth, near_pairs
from .clip import carved, clipped

#: Most pieces that are kept of one hull around a pit: a floor and walls around what is round.
MOST_WALLS = 10
#: Pieces of less than this share of what a pit takes are left out.
WALL_SHARE = 0.001
#: What turns may need so many times the room that it takes where it is modelled: a square stem.
TURNED_ROOM = 2.0

#: What lies no further ahead than this is touched [m].
MET_M = 0.003


@dataclass(frozen=True)
class Pit:
    """Makes room in one part for all of another's way.

    Attributes:
        holder: 0 or 1: which of two parts gives way.
        at_once: one room for all hulls of the other part, rather than one for each.
    """

    holder: int
    at_once: bool

    def __call__(
        self, a: Sequence[Hull], b: Sequence[Hull], poses: Sequence[FloatArray], clearance_m: float
    ) -> Sides:
        """See :func:`~.along.cut_apart_along`; only the holder's hulls are cut."""
        sides = list(a), list(b)
        mover = sides[1 - self.holder]
        way = seen_from(self.holder, poses)
        near = {
            number
            for pose in way
            for _, number in near_pairs(sides[self.holder], mover, pose, clearance_m)
        }
        bodies: list[Hull | None] = [mover[number] for number in sorted(near)]
        if self.at_once and near:
            bodies = [hull_of(np.concatenate([mover[number].vertices for number in sorted(near)]))]
        for body in bodies:
            room = None if body is None else _room(body, way)
            if room is not None:
                holder = sides[self.holder]
                holder[:] = [piece for hull in holder for piece in _around(hull, room, clearance_m)]
        return sides


def seen_from(holder: int, poses: Sequence[FloatArray]) -> Sequence[FloatArray]:
    """Return the same poses as the part of that number, 0 or 1, sees the other."""
    return poses if holder == 0 else [np.asarray(np.linalg.inv(pose)) for pose in poses]


def swept_share(
    holder: Sequence[Hull], mover: Sequence[Hull], poses: Sequence[FloatArray]
) -> float:
    """Return how many times the room it takes in its holder as modelled a part needs on its way.

    The poses are the mover's as seen from the holder, the first as modelled, [4, 4] each.
    """
    rest = _taken(holder, mover, poses[:1])
    return _taken(holder, mover, poses) / rest if rest > 0.0 else np.inf


def stands_out_m(holder: Sequence[Hull], mover: Sequence[Hull], joint: Joint) -> float:
    """Return how much further than its own travel a slide stands out of what it goes into [m].

    Infinite where it goes into nothing. Negative for other parts: those would go in deeper than
    they stand out, as a drawer that runs the wrong way does, or meet something further on.
    """
    points = np.concatenate([hull.vertices for hull in mover])
    ways = [(joint.upper, joint.axis), (-joint.lower, -joint.axis)]
    ways = [(travel, axis) for travel, axis in ways if travel > 0.0]
    spare = (_spare(points @ axis, _before(holder, points, axis), way) for way, axis in ways)
    return min(spare, default=np.inf)


def _spare(heights: FloatArray, before: list[tuple[float, float]], travel: float) -> float:
    """Return the same along one direction, in which the mover goes as far as it travels [m].

    Its points have some heights, and hulls of the holder lie in its shadow between others [m].
    """
    first = float(heights.min())
    lead = float(heights.max())
    end = lead
    begins = np.inf
    for low, high in sorted(before):
        if low > end + MET_M:
            # A gap: what lies behind it is out of reach, or run into.
            if low < lead + travel:
                return -travel
            break
        begins = min(begins, low)
        end = max(end, high)
    return begins - first - travel if end > lead else np.inf


def _before(
    holder: Sequence[Hull], points: FloatArray, direction: FloatArray
) -> list[tuple[float, float]]:
    """Return from where to where along a direction hulls lie in the shadow of points [m]."""
    across = np.linalg.svd(direction[None])[2][1:]
    found = []
    for hull in holder:
        left: Hull | None = hull
        for side in (*across, *-across):
            left = left and clipped(left, side, float((points @ side).max()))
        if left is not None:
            heights = left.vertices @ direction
            found.append((float(heights.min()), float(heights.max())))
    return found


def _room(hull: Hull, poses: Sequence[FloatArray]) -> Hull | None:
    """Return all the room that a hull takes on its way, as one."""
    return hull_of(np.concatenate([moved(hull.vertices, pose) for pose in poses]))


def _around(piece: Hull, room: Hull, clearance_m: float) -> list[Hull]:
    """Return the rest of a hull around a room; the hull itself where they do not meet."""
    if hull_depth([piece], [room], np.eye(4), clearance_m) <= -clearance_m:
        return [piece]
    corners = room.vertices
    low = corners.min(axis=0) - clearance_m
    size = corners.max(axis=0) + clearance_m - low
    shared = manifold_of_hull(piece) ^ Manifold.cube(size).translate(low)
    least = WALL_SHARE * float(shared.volume())
    return carved(piece, corners, clearance_m, MOST_WALLS, least)


def _taken(holder: Sequence[Hull], mover: Sequence[Hull], poses: Sequence[FloatArray]) -> float:
    """Return the volume of the holder's hulls in the room of each hull of the mover [m3]."""
    rooms = [room for hull in mover if (room := _room(hull, poses)) is not None]
    return volume_within(holder, rooms)
