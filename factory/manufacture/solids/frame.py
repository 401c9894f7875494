"""A frame along whose axes an object's panels lie: the object's own, turned about the vertical."""

from __future__ import annotations

import math

import numpy as np

from ...articulation import Articulation, rotation_about
from ...asset import Hull
from ...mesh import FloatArray

#: Smaller angles are those of panels, not of the object [rad].
LEAST_TURN = np.radians(1.5)


def working_frame(articulation: Articulation, parts: tuple[int, ...]) -> FloatArray:
    """Return the frame (rows) along whose axes the largest panel among some parts lies, [3, 3]."""
    given = (articulation.parts[part].panel for part in parts)
    panels = [panel for panel in given if panel is not None]
    if not panels:
        return np.eye(3)
    right = max(panels, key=lambda panel: float(panel.size.prod())).frame[0]
    # Sides are a quarter turn apart.
    turn = math.remainder(math.atan2(right[1], right[0]), math.pi / 2.0)
    return np.eye(3) if abs(turn) < LEAST_TURN else rotation_about([0.0, 0.0, 1.0], -turn)


def turned_hull(hull: Hull, rotation: FloatArray) -> Hull:
    """Return a hull turned, or mirrored, by ``rotation``, shape [3, 3]."""
    if np.array_equal(rotation, np.eye(3)):
        return hull
    faces = hull.faces[:, ::-1] if np.linalg.det(rotation) < 0.0 else hull.faces
    return Hull(hull.vertices @ rotation.T, faces)
