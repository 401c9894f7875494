"""Where the robot stands and where the cameras are: plain geometry, no simulator."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]

#: Between the gripper of a robot in its rest pose and the closed object's box [m].
GRIPPER_GAP = 0.12
#: A mobile robot starts this far from the handle and drives the rest [m].
MOBILE_DISTANCE = 1.3
#: An arm is comfortable this far above its base [m].
WORKING_HEIGHT = 0.35
CAMERA_FOV = 1.0


def facing_direction(point: FloatArray, pull: FloatArray, normal: FloatArray, bounds: FloatArray) -> FloatArray:
    """Unit horizontal direction from the object toward somebody about to open it, shape [3].

    The way the handle is pulled, if that is sideways; else the way its surface faces; else from the middle
    of the object to the handle; else -y.
    """
    from_middle = (point - bounds.mean(axis=0)) / max(float(np.ptp(bounds, axis=0).max()), 1e-9)
    for candidate in (pull, normal, from_middle):
        level = np.array([candidate[0], candidate[1], 0.0])
        length = float(np.linalg.norm(level))
        if length > 0.3:
            return np.asarray(level / length)
    return np.array([0.0, -1.0, 0.0])


def standing_place(
    point: FloatArray, direction: FloatArray, bounds: FloatArray, reach: float, *, mobile: bool
) -> tuple[FloatArray, float]:
    """Where a robot's base goes, and its heading.

    Args:
        point: the handle [m], shape [3].
        direction: from :func:`facing_direction`.
        bounds: of the closed object [m], shape [2, 3].
        reach: how far before its base the robot's gripper is in its rest pose [m].
        mobile: whether the robot drives; others are mounted at a height that suits the handle.

    Returns:
        Position [m], shape [3], and yaw [rad] at which the robot's x axis points at the handle.
    """
    corners = np.array([[x, y] for x in bounds[:, 0] for y in bounds[:, 1]])
    front = float(((corners - point[:2]) @ direction[:2]).max())
    # A robot that starts within the object is thrown out of it, and may throw it open.
    place = point + direction * max(front + reach + GRIPPER_GAP, MOBILE_DISTANCE if mobile else 0.0)
    place[2] = 0.0 if mobile else max(0.0, float(point[2]) - WORKING_HEIGHT)
    return place, math.atan2(-direction[1], -direction[0])


def camera_place(bounds: FloatArray, direction: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Eye and target [m] of a camera that sees the whole object and the robot before it, from the front left."""
    middle = bounds.mean(axis=0)
    radius = 0.5 * float(np.linalg.norm(np.ptp(bounds, axis=0))) + 0.4
    side = np.array([-direction[1], direction[0], 0.0])
    view = direction + 0.9 * side + np.array([0.0, 0.0, 0.6])
    distance = radius / math.tan(CAMERA_FOV / 2)
    target = middle + 0.25 * direction
    return target + view / np.linalg.norm(view) * distance, target
