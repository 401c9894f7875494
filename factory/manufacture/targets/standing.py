"""Where a robot's base stands to open a joint: beside the moving part, before its grasp."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from ...articulation import Joint
from ...asset import Asset, Target
from ...mesh import FloatArray
from ..poses import closed_values
from .shape import middle_of

#: Radius of the base, and what is left free around it [m].
BASE_RADIUS_M = 0.30
MARGIN_M = 0.05
#: Distances from the target to the middle of the base, the best first among equals being the
#: nearest to comfort [m].
DISTANCES_M = np.arange(0.5, 2.51, 0.05)
COMFORT_M = 0.75
#: Directions from the target, turned from straight ahead [rad].
TURNS = np.radians(np.arange(-90.0, 91.0, 15.0))
#: What a radian off straight ahead costs, in metres off the comfortable distance.
TURN_COST = 0.15
#: Joint values at which the moving parts are looked at.
STATIONS = 9


@dataclass(frozen=True)
class StandingPlace:
    """A place for a robot's base.

    Attributes:
        position: x and y, object frame [m], shape [2].
        yaw: about z, at which it faces the target with every joint closed [rad].
    """

    position: tuple[float, float]
    yaw: float


def standing_place(asset: Asset, joint: Joint, target: Target) -> StandingPlace | None:
    """Find the place nearest to comfort that reaches a closed object's target, clear of its way.

    The joint opens through all of its range. ``None`` if no place is near enough.
    """
    closed = closed_values(asset.articulation)
    point, facing = _aim(asset, closed, target)
    turns, distances = (each.reshape(-1) for each in np.meshgrid(TURNS, DISTANCES_M, indexing="ij"))
    heading = np.arctan2(facing[1], facing[0]) + turns
    away = np.stack([np.cos(heading), np.sin(heading)], axis=1)
    places = point[:2] + distances[:, None] * away
    clear = np.full(len(places), np.inf)
    for outline in _outlines(asset, joint, closed):
        clear = np.minimum(clear, _distance(outline, places))
    cost = np.abs(distances - COMFORT_M) + TURN_COST * np.abs(turns)
    # The ground may be anywhere near: what hangs high is kept clear of as well.
    cost = np.where(clear >= BASE_RADIUS_M + MARGIN_M, cost, np.inf)
    best = int(np.round(cost, 6).argmin())
    if not np.isfinite(cost[best]):
        return None
    x, y = places[best].tolist()
    return StandingPlace((x, y), float(np.arctan2(-away[best, 1], -away[best, 0])))


def _aim(asset: Asset, closed: dict[str, float], target: Target) -> tuple[FloatArray, FloatArray]:
    """Return where the target is [m] and a level unit direction away from the object, closed."""
    pose = asset.articulation.poses(closed)[target.part]
    point = pose[:3, :3] @ target.point + pose[:3, 3]
    vertices = asset.articulation.mesh.vertices
    middle = middle_of(vertices) if len(vertices) else np.zeros(3)
    # A hand comes against the normal; from straight above it comes from any side, best from the
    # object's own front.
    for direction in (pose[:3, :3] @ target.normal, pose[:3, :3] @ target.pull, point - middle):
        level = direction[:2]
        if np.linalg.norm(level) > 0.3 * np.linalg.norm(direction) > 0.0:
            return point, np.asarray(level / np.linalg.norm(level))
    return point, np.array([0.0, -1.0])


def _outlines(asset: Asset, joint: Joint, closed: dict[str, float]) -> list[FloatArray]:
    """Return convex ground outlines of all that is closed, and of what the joint moves."""
    articulation = asset.articulation
    moved = articulation.carried(joint.child)
    solids = [_solids(asset, part) for part in range(len(articulation.parts))]
    outlines: list[FloatArray] = []
    for value in np.linspace(joint.lower, joint.upper, STATIONS):
        poses = articulation.poses({**closed, **articulation.together(joint, float(value))})
        for part, pose in enumerate(poses):
            if part in moved or value == joint.lower:
                outlines += [_outline(each @ pose[:2, :3].T + pose[:2, 3]) for each in solids[part]]
    return outlines


def _solids(asset: Asset, part: int) -> list[FloatArray]:
    hulls = asset.bodies[part].hulls
    if hulls:
        return [hull.vertices for hull in hulls]
    mesh = asset.articulation.mesh
    faces = mesh.faces[asset.articulation.parts[part].faces]
    return [mesh.vertices[np.unique(faces)]] if len(faces) else []


def _outline(points: FloatArray) -> FloatArray:
    """Return the corners of the convex outline, counter-clockwise, shape [corner_count, 2]."""
    try:
        return np.asarray(points[ConvexHull(points).vertices])
    except QhullError:
        # All on one line: its box is as good.
        (x0, y0) = points.min(axis=0)
        (x1, y1) = points.max(axis=0)
        return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])


def _distance(outline: FloatArray, places: FloatArray) -> FloatArray:
    """Return the distance of points from a convex outline [m], 0 within it, shape [point_count]."""
    edges = np.roll(outline, -1, axis=0) - outline
    offset = places[:, None] - outline
    square = np.maximum((edges**2).sum(axis=1), 1e-18)
    along = np.clip((offset * edges).sum(axis=2) / square, 0.0, 1.0)
    distance = np.linalg.norm(offset - along[:, :, None] * edges, axis=2).min(axis=1)
    within = (edges[:, 0] * offset[:, :, 1] - edges[:, 1] * offset[:, :, 0] >= 0.0).all(axis=1)
    return np.where(within, 0.0, distance)
