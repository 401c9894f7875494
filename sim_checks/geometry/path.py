"""The motion of joints as a path of rigid motions in the world, and how far points get along it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..description import FloatArray, JointLine
from .kinematics import unit_axis


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
        """Return the motion at ``at``, identity at 0; shape [4, 4]."""
        pose: FloatArray = self.poses(np.array([at]))[0]
        return pose

    def poses(self, at: FloatArray) -> FloatArray:
        """Return the motion at many places, shape [place_count] -> [place_count, 4, 4]."""
        poses = np.tile(np.eye(4), (len(at), 1, 1))
        if self.turning:
            sine = np.sin(at)[:, None, None]
            cosine = np.cos(at)[:, None, None]
            cross = self._cross
            poses[:, :3, :3] = np.eye(3) + sine * cross + (1.0 - cosine) * (cross @ cross)
            poses[:, :3, 3] = self.origin - poses[:, :3, :3] @ self.origin
        else:
            poses[:, :3, 3] = at[:, None] * self.axis
        return poses

    @cached_property
    def _cross(self) -> FloatArray:
        """Return the matrix whose product with a vector is the axis' cross product with it."""
        return np.cross(self.axis, np.eye(3)).T

    def inverse(self) -> Path:
        """Return the motion of the fixed links, seen from the moving ones."""
        return replace(self, axis=-self.axis)

    def unturned(self, vector: FloatArray, at: float) -> FloatArray:
        """Turn a world direction at ``at`` back to 0, as if fixed to the moving body."""
        return self.pose(-at)[:3, :3] @ vector if self.turning else vector

    def orbit(self, points: FloatArray) -> Orbit:
        """Return how points [m] travel that are at their places at 0; shape [point_count, 3]."""
        arm = points - self.origin
        along = (arm @ self.axis)[:, None] * self.axis
        radial = arm - along
        return Orbit(self, points, self.origin + along, radial, np.cross(self.axis, radial))

    def travel(self, points: FloatArray) -> float:
        """Return how far the fastest of the points goes [m]."""
        return self.length * float(self.limits(points)[0].max(initial=0.0))

    def limits(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return each point's speed [m per unit] and acceleration [m per unit squared]."""
        if not self.turning:
            return np.ones(len(points)), np.zeros(len(points))
        radius = np.linalg.norm(self.orbit(points).radial, axis=1)
        return radius, radius


@dataclass(frozen=True)
class Orbit:
    """Points on a path: ``center + radial cos + tangent sin`` on a turn; all [point_count, 3]."""

    path: Path
    start: FloatArray
    center: FloatArray
    radial: FloatArray
    tangent: FloatArray

    def highest(self, direction: FloatArray, starts: FloatArray, ends: FloatArray) -> FloatArray:
        """Return the upper bound of the points' height along a direction within each interval.

        Exact on a slide.

        Args:
            direction: unit vector, shape [3].
            starts: where the intervals begin [rad] or [m], shape [interval_count].
            ends: where they end, likewise.

        Returns:
            heights [m], shape [interval_count].
        """
        if not self.path.turning:
            slope = self.path.axis @ direction
            slid: FloatArray = (self.start @ direction).max()
            return slid + np.maximum(starts * slope, ends * slope)
        cosine = self.radial @ direction
        sine = self.tangent @ direction
        at = np.concatenate([starts, ends])
        heights = (self.center @ direction)[:, None] + np.outer(cosine, np.cos(at))
        heights = heights + np.outer(sine, np.sin(at))
        reach = heights.max(axis=0)
        higher: FloatArray = np.maximum(reach[: len(starts)], reach[len(starts) :])
        return higher + bulge(float(np.hypot(cosine, sine).max()), ends - starts)

    def swept_bounds(self, at: FloatArray) -> FloatArray:
        """Return the boxes that hold the points all the way between neighbouring places.

        Returns:
            lowest and highest corners [m], shape [place_count - 1, 2, 3].
        """
        if self.path.turning:
            cos = np.cos(at)[:, None, None]
            sin = np.sin(at)[:, None, None]
            points = self.center + self.radial * cos + self.tangent * sin
            # Rounding of the circle itself is far below a nanometre.
            radius = np.hypot(self.radial, self.tangent).max(axis=0)
            margin = bulge(1.0, np.diff(at))[:, None] * radius
        else:
            points = self.start + at[:, None, None] * self.path.axis
            margin = np.zeros((len(at) - 1, 3))
        return boxed(points, margin)


def joint_path(joint: JointLine, pose: FloatArray, length: float) -> Path:
    """Return the way a joint by itself moves what hangs below it, from a posed value on.

    Args:
        joint: which moves.
        pose: of the joint's child there, in the world, shape [4, 4].
        length: how far it goes [rad] or [m].
    """
    # The axis is the same line in the child's frame at every value.
    return Path(joint.kind != "prismatic", pose[:3, 3], pose[:3, :3] @ unit_axis(joint), length)


def boxed(points: FloatArray, margin: FloatArray) -> FloatArray:
    """Return the boxes around points [m] at neighbouring places.

    Args:
        points: shape [place_count, point_count, 3].
        margin: how far they get beyond between two places [m], shape [place_count - 1, 3 or 1].

    Returns:
        lowest and highest corners [m], shape [place_count - 1, 2, 3].
    """
    low = points.min(axis=1)
    high = points.max(axis=1)
    lowest = np.minimum(low[:-1], low[1:]) - margin
    return np.stack([lowest, np.maximum(high[:-1], high[1:]) + margin], axis=1)


def bulge(radius: float, step: FloatArray) -> FloatArray:
    """Return how far a circling point can rise above the higher of a step's two ends [m]."""
    return radius * (1.0 - np.cos(0.5 * np.minimum(step, 2.0 * np.pi)))
