"""Where a robot's base stands to open a joint: beside the moving part, before its grasp."""

from __future__ import annotations

import numpy as np

from ...articulation import Joint
from ...asset import Asset, StandingPlace, Target
from ...geometry.posing import closed_values
from ...mesh import FloatArray
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


def standing_place(asset: Asset, joint: Joint, target: Target) -> StandingPlace | None:
    """Find the place nearest to comfort that reaches a closed object's target, clear of its way.

    The joint opens through all of its range. ``None`` if no place is near enough.
    """
    articulation = asset.articulation
    closed = closed_values(articulation)
    pose = articulation.poses(closed)[target.part]
    point = pose[:3, :3] @ target.point + pose[:3, 3]
    # A hand comes against the normal; from straight above it comes from any side, best from the
    # object's own front.
    facing = facing_direction(
        pose[:3, :3] @ target.normal,
        pose[:3, :3] @ target.pull,
        point - middle_of(articulation.mesh.vertices),
    )
    turns, distances = (each.reshape(-1) for each in np.meshgrid(TURNS, DISTANCES_M, indexing="ij"))
    heading = np.arctan2(facing[1], facing[0]) + turns
    away = np.stack([np.cos(heading), np.sin(heading)], axis=1)
    places = point[:2] + distances[:, None] * away
    low, high = _boxes(asset, joint, closed).transpose(1, 0, 2)
    beyond = np.maximum(low - places[:, None], places[:, None] - high)
    clear = np.linalg.norm(np.maximum(beyond, 0.0), axis=2).min(axis=1)
    cost = np.abs(distances - COMFORT_M) + TURN_COST * np.abs(turns)
    # The ground may be anywhere near: what hangs high is kept clear of as well.
    cost = np.where(clear >= BASE_RADIUS_M + MARGIN_M, cost, np.inf)
    best = int(np.round(cost, 6).argmin())
    if not np.isfinite(cost[best]):
        return None
    x, y = places[best].tolist()
    return StandingPlace((x, y), float(np.arctan2(-away[best, 1], -away[best, 0])))


def facing_direction(*ways: FloatArray) -> FloatArray:
    """Return the level unit direction of the first way that is not nearly upright, else -y, [3]."""
    for way in ways:
        level = np.array([way[0], way[1], 0.0])
        length = float(np.linalg.norm(level))
        if length > 0.3 * np.linalg.norm(way):
            return np.asarray(level / length)
    return np.array([0.0, -1.0, 0.0])


def _boxes(asset: Asset, joint: Joint, closed: dict[str, float]) -> FloatArray:
    """Return level boxes around the hulls of all that is closed, and of what the joint moves [m].

    Shape [box_count, 2, 2].
    """
    articulation = asset.articulation
    moved = articulation.carried(joint.child)
    boxes = []
    for value in np.linspace(joint.lower, joint.upper, STATIONS):
        poses = articulation.poses({**closed, **articulation.together(joint, float(value))})
        for part, pose in enumerate(poses):
            if part in moved or value == joint.lower:
                for hull in asset.bodies[part].hulls:
                    corners = hull.vertices @ pose[:2, :3].T + pose[:2, 3]
                    boxes.append([corners.min(axis=0), corners.max(axis=0)])
    return np.array(boxes)
