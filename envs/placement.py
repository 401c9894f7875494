"""Where the robot stands and where the cameras are: plain geometry, no simulator."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from asset_factory.factory.manufacture.targets.standing import TURN_COST, TURNS, facing_direction

from .assets import FloatArray, OpenableJoint, RegisteredAsset
from .geometry import (
    STATIONS,
    carried_links,
    closed_values,
    handle_path,
    hull_boxes,
    opening_values,
)
from .robots import Robot

#: Free space between a robot and the object, before the start is shaken by a few centimetres [m].
MARGIN = 0.06
#: The candidates: this far from the handle [m], this far below it [m]. A Panda reaches straight
#: ahead from half a metre above its base, best at 0.7 m; lower its wrist's limit forbids it.
DISTANCES = np.arange(0.35, 1.96, 0.05)
DROPS = (0.7, 0.6, 0.5)
#: What a metre beyond reach, at the start and on the way, and of overlap cost, in metres off the
#: ideal distance.
REACH_COST = 10.0
WAY_COST = 2.0
OVERLAP_COST = 100.0
#: As many candidates at once are tried with the whole arm.
ARM_TRIALS = 96
CAMERA_FOV = 1.0


@dataclass(frozen=True)
class Place:
    """Where a robot's base goes.

    Attributes:
        position: [m], shape [3].
        yaw: at which the robot's x axis points at the handle [rad].
        stretch: how far the handle gets out of comfortable reach [m]; 0 is well. A robot that
            drives is asked only for where the handle starts, another for all of its way.
        clearance: least distance to the object, and to its moving part on its way, of the base; to
            the object as it starts of the arm [m]. Negative where nothing better was found.
    """

    position: FloatArray
    yaw: float
    stretch: float
    clearance: float


def find_place(
    asset: RegisteredAsset,
    joint: OpenableJoint,
    robot: Robot,
    *,
    start: float = 0.0,
    spread: float = 0.0,
) -> Place:
    """Return the best place for a robot to move a joint from.

    A grid of places around the handle is searched for one from which the handle stays within
    comfortable reach, where the base is clear of the object and of whatever the joint swings, and
    where the arm at rest is clear of the object.

    Args:
        asset: the object, standing on the ground, its root at the origin.
        joint: to be moved; everything else is closed.
        robot: who is put there.
        start: how far the joint is open when the robot arrives, a share of its range.
        spread: how much more or less than that it may be.
    """
    starts = np.clip([start - spread, start, start + spread], 0.0, 1.0)
    shares = np.linspace(0.0, 1.0, STATIONS)
    begin = handle_path(asset, joint, starts[1:2])
    path = begin if robot.mobile else np.concatenate([begin, handle_path(asset, joint, shares)])
    moving = carried_links(asset, joint)
    others = frozenset(link.name for link in asset.manifest.links) - moving
    still = hull_boxes(asset, closed_values(asset), others)
    opened = (opening_values(asset, joint, at) for at in (shares, np.unique(starts)))
    boxes = ((hull_boxes(asset, values, moving) for values in each) for each in opened)
    swept, begun = (np.concatenate([still, *each]) for each in boxes)

    places, turns = _candidates(path, facing_of(asset, joint), robot)
    directions = path[0, :2] - places[:, :2]
    yaws = np.arctan2(directions[:, 1], directions[:, 0])
    stretch = _stretch(places, yaws, path, robot)
    ideal = 0.5 * (robot.near + robot.far)
    off = np.abs(np.linalg.norm(directions, axis=1) - ideal)
    clear = _body_clearance(places, swept, robot)
    # What cannot be reached as it starts is never opened; further on another hold may do.
    reach = REACH_COST * _stretch(places, yaws, path[:1], robot) + WAY_COST * stretch
    cost = off + reach + TURN_COST * np.abs(turns) + OVERLAP_COST * np.maximum(MARGIN - clear, 0.0)

    best = Place(places[0], float(yaws[0]), float(stretch[0]), -np.inf)
    least = np.inf
    # The whole arm is tried for the likely best first, and for nothing that cannot win any more.
    for tried in np.array_split(np.argsort(cost, kind="stable"), math.ceil(len(cost) / ARM_TRIALS)):
        if cost[tried[0]] >= least:
            break
        arm_clear = _arm_clearance(places[tried], yaws[tried], begun, robot)
        total = cost[tried] + OVERLAP_COST * np.maximum(MARGIN - arm_clear, 0.0)
        first = int(np.argmin(total))
        if total[first] < least:
            index = int(tried[first])
            least = float(total[first])
            clearance = float(min(clear[index], arm_clear[first]))
            best = Place(places[index], float(yaws[index]), float(stretch[index]), clearance)
    return best


def _candidates(
    path: FloatArray, facing: FloatArray, robot: Robot
) -> tuple[FloatArray, FloatArray]:
    """Return the base positions [m], shape [count, 3], and headings [rad], shape [count].

    A heading is the turn away from straight ahead.
    """
    start = path[0]
    middle = 0.5 * (path[:, 2].min() + path[:, 2].max())
    heights = [0.0] if robot.mobile else sorted({max(0.0, float(middle) - drop) for drop in DROPS})
    grids = np.meshgrid(TURNS, DISTANCES, heights, indexing="ij")
    turn, distance, height = (grid.ravel() for grid in grids)
    angle = math.atan2(facing[1], facing[0]) + turn
    flat = start[:2] + distance[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return np.column_stack([flat, height]), turn


def _in_world(places: FloatArray, yaws: FloatArray, points: FloatArray) -> FloatArray:
    """Return the points of the base frame at every place [m], shape [place, point, 3]."""
    cos = np.cos(yaws)[:, None]
    sin = np.sin(yaws)[:, None]
    x, y, z = points.T
    level = np.broadcast_to(z, (len(yaws), len(z)))
    turned = np.stack([cos * x - sin * y, sin * x + cos * y, level], -1)
    return np.asarray(turned + places[:, None])


def _stretch(places: FloatArray, yaws: FloatArray, path: FloatArray, robot: Robot) -> FloatArray:
    """Return how far the path gets out of comfortable reach [m], shape [place]."""
    shoulders = _in_world(places, yaws, np.array([robot.shoulder]))
    offset = path[None] - shoulders
    lowered = np.clip(-offset[..., 2], 0.0, robot.lift)
    offset[..., 2] += lowered
    distance = np.linalg.norm(offset, axis=-1)
    beyond = np.maximum(distance - robot.far, robot.near - distance)
    return np.asarray(np.maximum(beyond, 0.0).max(axis=1))


def _body_clearance(places: FloatArray, boxes: FloatArray, robot: Robot) -> FloatArray:
    """Return the upright body's level distance to all boxes at its height [m], shape [place]."""
    radius, height = robot.body
    low, high = boxes.transpose(1, 0, 2)
    feet = places[:, None]
    distance = _distance(np.maximum(low[:, :2] - feet[..., :2], feet[..., :2] - high[:, :2]))
    beside = (low[:, 2] < feet[..., 2] + height) & (high[:, 2] > feet[..., 2] - MARGIN)
    return np.asarray(np.where(beside, distance, np.inf).min(axis=1, initial=np.inf) - radius)


def _distance(gap: FloatArray) -> FloatArray:
    """Return the distance to boxes by the gap along each axis, negative inside [m]."""
    beyond = np.linalg.norm(np.maximum(gap, 0.0), axis=-1)
    return np.asarray(beyond + np.minimum(gap.max(axis=-1), 0.0))


def _arm_clearance(
    places: FloatArray, yaws: FloatArray, boxes: FloatArray, robot: Robot
) -> FloatArray:
    """Return the distance between the arm at rest and all boxes [m], shape [place]."""
    points = _in_world(places, yaws, robot.arm)[:, :, None]
    distance = _distance(np.maximum(boxes[:, 0] - points, points - boxes[:, 1]))
    return np.asarray(distance.min(axis=(1, 2), initial=np.inf) - robot.arm_radius)


def facing_of(asset: RegisteredAsset, joint: OpenableJoint) -> FloatArray:
    """Return the level unit direction from an object to who is about to open a joint, shape [3].

    The way the handle is pulled, if that is sideways; else the way its surface faces; else from the
    middle of the object to the handle; else -y.
    """
    from_middle = joint.rest_point - asset.bounds.mean(axis=0)
    return facing_direction(joint.pull, joint.normal, from_middle)


def camera_place(bounds: FloatArray, direction: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return eye and target [m] of a camera at the front left that sees all of object and robot."""
    middle = bounds.mean(axis=0)
    radius = 0.5 * float(np.linalg.norm(np.ptp(bounds, axis=0))) + 0.4
    side = np.array([-direction[1], direction[0], 0.0])
    view = direction + 0.9 * side + np.array([0.0, 0.0, 0.6])
    distance = radius / math.tan(CAMERA_FOV / 2)
    target = middle + 0.25 * direction
    return target + view / np.linalg.norm(view) * distance, target
