"""The motion of one joint as a path of rigid motions in the world, and how far points get along it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .description import FloatArray
from .kinematics import rotation_about


@dataclass(frozen=True)
class Path:
    """A turn about, or a slide along, a fixed line.

    Attributes:
        turning: a rotation; else a translation.
        origin: a point of the axis [m], world frame, shape [3].
        axis: unit direction, world frame, shape [3].
        length: how far it goes, from 0 [rad] or [m].
    """

    turning: bool
    origin: FloatArray
    axis: FloatArray
    length: float

    def pose(self, at: float) -> FloatArray:
        """The motion at ``at``, identity at 0; shape [4, 4]."""
        pose = np.eye(4)
        if self.turning:
            pose[:3, :3] = rotation_about(self.axis, at)
            pose[:3, 3] = self.origin - pose[:3, :3] @ self.origin
        else:
            pose[:3, 3] = at * self.axis
        return pose

    def turned(self, vector: FloatArray, at: float) -> FloatArray:
        """A direction fixed to the moving body, seen from the world at ``at``."""
        return rotation_about(self.axis, at) @ vector if self.turning else vector

    def orbit(self, points: FloatArray) -> Orbit:
        """How points [m] travel that are at their places at 0; shape [point_count, 3]."""
        arm = points - self.origin
        along = (arm @ self.axis)[:, None] * self.axis
        radial = arm - along
        return Orbit(self, points, self.origin + along, radial, np.cross(self.axis, radial))

    def travel(self, points: FloatArray) -> float:
        """How far the fastest of the points goes [m]."""
        if not self.turning:
            return self.length
        return self.length * float(np.linalg.norm(self.orbit(points).radial, axis=1).max(initial=0.0))


@dataclass(frozen=True)
class Orbit:
    """Points on a path: ``center + radial cos + tangent sin`` on a turn. All shapes [point_count, 3]."""

    path: Path
    start: FloatArray
    center: FloatArray
    radial: FloatArray
    tangent: FloatArray

    def extents(self, direction: FloatArray, at: FloatArray, sign: float = 1.0) -> tuple[FloatArray, float]:
        """The largest coordinate along a direction, for each place on the path.

        Args:
            direction: unit vector, shape [3].
            at: places [rad] or [m], shape [place_count].
            sign: -1 to run the path backwards.

        Returns:
            extents [m], shape [place_count], and the largest radius [m] at which a point circles across the
            direction, which bounds how far extents bulge between places (see :func:`bulge`).
        """
        if not self.path.turning:
            return (self.start @ direction).max() + sign * at * (self.path.axis @ direction), 0.0
        cosine, sine = self.radial @ direction, sign * (self.tangent @ direction)
        height = self.center @ direction
        all_extents = height[:, None] + np.outer(cosine, np.cos(at)) + np.outer(sine, np.sin(at))
        return all_extents.max(axis=0), float(np.hypot(cosine, sine).max())

    def swept_bounds(self, at: FloatArray) -> FloatArray:
        """Boxes that hold the points all the way between neighbouring places.

        Returns:
            lowest and highest corners [m], shape [place_count - 1, 2, 3].
        """
        if self.path.turning:
            cos, sin = np.cos(at)[:, None, None], np.sin(at)[:, None, None]
            points = self.center + self.radial * cos + self.tangent * sin
            # Rounding of the circle itself is far below a nanometre.
            margin = bulge(1.0, np.diff(at))[:, None] * np.hypot(self.radial, self.tangent).max(axis=0)
        else:
            points = self.start + at[:, None, None] * self.path.axis
            margin = np.zeros((len(at) - 1, 3))
        low, high = points.min(axis=1), points.max(axis=1)
        return np.stack([np.minimum(low[:-1], low[1:]) - margin, np.maximum(high[:-1], high[1:]) + margin], axis=1)


def bulge(radius: float, step: FloatArray) -> FloatArray:
    """How far a circling point can rise above the higher of its coordinates at both ends of a step [m]."""
    rise: FloatArray = radius * (1.0 - np.cos(0.5 * np.minimum(step, 2.0 * np.pi)))
    return rise
