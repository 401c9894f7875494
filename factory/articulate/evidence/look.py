"""What a part looks like to somebody who wants to open it: where its front is, and its handle."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...mesh import BoolArray, FloatArray
from .body import Body

#: Steps of the walk that finds out which side is open.
WALK = 14
#: A handle is at most, and at least, this share of the surface.
HANDLE = (0.002, 0.35)


@dataclass(frozen=True)
class Look:
    """A part as seen from outside.

    Attributes:
        front: unit direction of its largest open side, shape [3].
        facing: share of the surface that looks along ``front`` (either way), 0 to 1.
        center: of the part's box, level frame, in object coordinates [m], shape [3].
        extents: of the part along the level frame's axes [m], shape [3].
        thickness: along ``front``, handle apart [m].
        middle: of the slab, along ``front`` [m].
        handle: middle of the protrusions of the front [m]; ``None`` without.
        sides: the directions looked from, both ways along the frames' axes, shape [side_count, 3].
        free: how free each of them is, 0 to 1, shape [side_count].
    """

    front: FloatArray
    facing: float
    center: FloatArray
    extents: FloatArray
    thickness: float
    middle: float
    handle: FloatArray | None
    sides: FloatArray
    free: FloatArray


def look_at(body: Body) -> Look:
    """Return the part's front and handle."""
    directions = np.array(
        [sign * row for frame in body.frames for row in frame for sign in (1.0, -1.0)]
    )
    free = free_share(body, directions)
    facing = np.abs(body.own.normals @ directions.T).mean(axis=0)
    best = int(np.argmax(free * (0.2 + facing) * (1.0 + 0.1 * stands_out(body, directions))))
    front = directions[best]
    level = body.corners @ body.partition.level.T
    low = level.min(axis=0)
    high = level.max(axis=0)
    back_plane, plane = _slab(body, front)
    held = _handle(body, front)
    return Look(
        front=front,
        facing=float(facing[best]),
        center=(low + high) / 2.0 @ body.partition.level,
        extents=high - low,
        thickness=plane - back_plane,
        middle=(plane + back_plane) / 2.0,
        handle=body.moving.points[held].mean(axis=0) if held.any() else None,
        sides=directions,
        free=free,
    )


def free_share(body: Body, directions: FloatArray) -> FloatArray:
    """Return the share of the part's points that nothing hides, per direction, [direction_count].

    What only neighbours stand in front of, which may move out of the way as a door does, counts
    half.
    """
    points = body.probes.points
    step = 0.7 * body.diagonal / WALK
    distances = 2.0 * body.grid.cell + step * np.arange(WALK)
    walked = points[None, None] + distances[None, :, None, None] * directions[:, None, None, :]
    free = 1.0 - body.grid.filled(walked).any(axis=1).mean(axis=1)
    if not body.crowded:
        return np.asarray(free)
    held = 1.0 - body.holder.filled(walked).any(axis=1).mean(axis=1)
    return np.asarray((free + held) / 2.0)


def stands_out(body: Body, directions: FloatArray) -> FloatArray:
    """Return 1 where something small protrudes along a direction, shape [direction_count]."""
    return np.array([float(_handle(body, direction).any()) for direction in directions])


def _handle(body: Body, direction: FloatArray) -> BoolArray:
    """Tell which points of what moves protrude along a direction, if few do, [point_count]."""
    beyond = body.moving.points @ direction > _slab(body, direction)[1] + 0.02 * body.diagonal
    return np.asarray(beyond & (HANDLE[0] < beyond.mean() < HANDLE[1]))


def _slab(body: Body, direction: FloatArray) -> tuple[float, float]:
    """Return first and last heavy plane along a direction [m]; the part's ends if it has none."""
    along = body.own.points @ direction
    low = float(along.min())
    first, last = body.heavy_planes(direction, low) or (low, float(along.max()))
    return first, last
