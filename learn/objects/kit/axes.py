"""Axes, directions along them, and faces across them. Lengths are in metres."""

from __future__ import annotations

import numpy as np

from asset_factory.factory.mesh import FloatArray

Point = tuple[float, float, float]

X = 0
Y = 1
Z = 2
#: Directions of axes; what hangs at the back of its lid opens about LEFT.
LEFT = (-1.0, 0.0, 0.0)
RIGHT = (1.0, 0.0, 0.0)
FRONT = (0.0, -1.0, 0.0)
BACK = (0.0, 1.0, 0.0)
DOWN = (0.0, 0.0, -1.0)
UP = (0.0, 0.0, 1.0)

#: A face on which something is built as if the face were the plane y = 0, seen from -Y: from there
#: to the object, shape [4, 4].
Place = FloatArray


def _placed(right: Point, inwards: Point, up: Point, origin: Point) -> Place:
    matrix = np.eye(4)
    matrix[:3] = np.stack([right, inwards, up, origin], axis=1)
    return matrix


def facing_front(y: float) -> Place:
    """Return the face at ``y`` that looks towards -Y."""
    return _placed(RIGHT, BACK, UP, (0.0, y, 0.0))


def facing_up(z: float) -> Place:
    """Return the face at ``z`` that looks up; its own up is the object's +Y."""
    return _placed(RIGHT, DOWN, BACK, (0.0, 0.0, z))


def facing_side(x: float) -> Place:
    """Return the face at ``x`` that looks away from the middle, to the right for ``x`` above 0."""
    if x > 0.0:
        return _placed(BACK, LEFT, UP, (x, 0.0, 0.0))
    return _placed(FRONT, RIGHT, UP, (x, 0.0, 0.0))
