"""Motions of joints as paths of rigid motions in the world, and how far points get along them.

What one part sees of another may move by several joints at once, each at its own rate, where some
follow others. Such a motion is no turn about one line, but it is smooth: how strongly a point can
be accelerated is known in closed form, and bounds how far it gets beyond its places at both ends of
an interval.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property, reduce

import numpy as np

from ..description import FloatArray, JointLine
from .kinematics import unit_axis

#: Intervals in which all that moves is boxed in before anything finer is asked.
BOXED_STEPS = 32


@dataclass(frozen=True)
class JointAxis:
    """A line fixed in the world, about which something turns or along which it slides.

    Attributes:
        turning: a rotation; else a translation.
        origin: a point of the line [m], world frame, shape [3].
        axis: unit direction, world frame, shape [3].
    """

    turning: bool
    origin: FloatArray
    axis: FloatArray

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

    def arms(self, points: FloatArray) -> FloatArray:
        """Return the shortest ways from the line to points [m], shape [point_count, 3] -> same."""
        arm = points - self.origin
        arms: FloatArray = arm - (arm @ self.axis)[:, None] * self.axis
        return arms

    def path(self, length: float) -> Path:
        """Return the way along or about this line alone, so far [rad] or [m]."""
        return Path(((self, 1.0),), length)


@dataclass(frozen=True)
class Path:
    """Turns and slides about lines fixed in the world, carried out one within the other.

    Attributes:
        steps: each line, and how far it goes for each unit of the path; the outermost first.
        length: how far the path goes, from 0 [rad] or [m] of the joint that leads.
    """

    steps: tuple[tuple[JointAxis, float], ...]
    length: float

    @cached_property
    def turning(self) -> bool:
        """Return whether anything turns."""
        return any(line.turning for line, _ in self.steps)

    def pose(self, at: float) -> FloatArray:
        """Return the motion at ``at``, identity at 0; shape [4, 4]."""
        pose: FloatArray = self.poses(np.array([at]))[0]
        return pose

    def poses(self, at: FloatArray) -> FloatArray:
        """Return the motion at many places, shape [place_count] -> [place_count, 4, 4]."""
        start = np.tile(np.eye(4), (len(at), 1, 1))
        return reduce(np.matmul, (line.poses(rate * at) for line, rate in self.steps), start)

    def inverse(self) -> Path:
        """Return the motion of the fixed links, seen from the moving ones."""
        back = ((replace(line, axis=-line.axis), rate) for line, rate in reversed(self.steps))
        return Path(tuple(back), self.length)

    def orbit(self, points: FloatArray) -> Orbit | CoupledOrbit:
        """Return how points [m] travel that are at their places at 0; shape [point_count, 3]."""
        if len(self.steps) > 1 or self.steps[0][1] != 1.0:
            return CoupledOrbit(self, points)
        line = self.steps[0][0]
        radial = line.arms(points)
        return Orbit(line, points, points - radial, radial, np.cross(line.axis, radial))

    def travel(self, points: FloatArray) -> float:
        """Return at least as far as the fastest of the points goes [m]."""
        return self.length * float(self.limits(points)[0].max(initial=0.0))

    def limits(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Bound each point's speed [m per unit] and acceleration [m per unit squared]."""
        moved, speed, acceleration = (np.zeros(len(points)) for _ in range(3))
        for line, rate in reversed(self.steps):
            turned = abs(rate)
            if not line.turning:
                moved = moved + turned * self.length
                speed = speed + turned
                continue
            # What is carried may have moved away from the line before it turns.
            radius = np.linalg.norm(line.arms(points), axis=1) + moved
            acceleration = acceleration + 2.0 * turned * speed + turned**2 * radius
            speed = speed + turned * radius
            moved = moved + min(turned * self.length, 2.0) * radius
        return speed, acceleration

    def swept_boxes(self, points: FloatArray) -> FloatArray:
        """Return boxes around all that points [m] sweep, by interval, [interval_count, 2, 3]."""
        return self.orbit(points).swept_bounds(np.linspace(0.0, self.length, BOXED_STEPS + 1))


@dataclass(frozen=True)
class Orbit:
    """Points about one line: ``center + radial cos + tangent sin`` on a turn, [point_count, 3]."""

    line: JointAxis
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
        if not self.line.turning:
            slope = self.line.axis @ direction
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
        if self.line.turning:
            cos = np.cos(at)[:, None, None]
            sin = np.sin(at)[:, None, None]
            points = self.center + self.radial * cos + self.tangent * sin
            # Rounding of the circle itself is far below a nanometre.
            radius = np.hypot(self.radial, self.tangent).max(axis=0)
            margin = bulge(1.0, np.diff(at))[:, None] * radius
        else:
            points = self.start + at[:, None, None] * self.line.axis
            margin = np.zeros((len(at) - 1, 3))
        return boxed(points, margin)


@dataclass(frozen=True)
class CoupledOrbit:
    """Points on a path of several steps, or of another rate than 1.

    Attributes:
        path: theirs.
        start: places at 0 [m], shape [point_count, 3].
    """

    path: Path
    start: FloatArray

    @cached_property
    def acceleration(self) -> FloatArray:
        """Bound each point's acceleration [m per unit squared], shape [point_count]."""
        return self.path.limits(self.start)[1]

    def highest(self, direction: FloatArray, starts: FloatArray, ends: FloatArray) -> FloatArray:
        """Return what :meth:`Orbit.highest` does, exact where nothing turns."""
        first, last = (self._heights(direction, at) for at in (starts, ends))
        rise = np.outer((ends - starts) ** 2 / 8.0, self.acceleration)
        higher: FloatArray = (np.maximum(first, last) + rise).max(axis=1)
        return higher

    def swept_bounds(self, at: FloatArray) -> FloatArray:
        """Return what :meth:`Orbit.swept_bounds` does."""
        poses = self.path.poses(at)
        points = self.start @ poses[:, :3, :3].transpose(0, 2, 1) + poses[:, None, :3, 3]
        return boxed(points, np.diff(at)[:, None] ** 2 / 8.0 * self.acceleration.max())

    def _heights(self, direction: FloatArray, at: FloatArray) -> FloatArray:
        poses = self.path.poses(at)
        lifted = (poses[:, :3, 3] @ direction)[:, None]
        return (direction @ poses[:, :3, :3]) @ self.start.T + lifted


def joint_axis(joint: JointLine, pose: FloatArray) -> JointAxis:
    """Return the line about or along which a joint moves what hangs below it.

    The pose is that of the joint's child in the world at some value, shape [4, 4].
    """
    # The axis is the same line in the child's frame at every value.
    return JointAxis(joint.kind != "prismatic", pose[:3, 3], pose[:3, :3] @ unit_axis(joint))


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
