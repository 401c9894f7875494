"""How one part moves as seen from another when several joints move at once, each at its own rate.

Joints that follow another make such motions. They are no turn about one line, but they are smooth:
how strongly a point can be accelerated is known in closed form, and bounds how far it gets beyond
its places at both ends of an interval.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, reduce

import numpy as np

from ..description import FloatArray
from .path import Path, boxed

#: Intervals in which all that moves is boxed in before anything finer is asked.
BOXED_STEPS = 32


@dataclass(frozen=True)
class CoupledPath:
    """Turns and slides about lines fixed in the world, carried out one within the other.

    Attributes:
        steps: each line, and how far it goes for each unit of the path; the outermost first.
        length: how far the path goes, from 0 [rad] or [m] of the joint that leads.
    """

    steps: tuple[tuple[Path, float], ...]
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

    def inverse(self) -> CoupledPath:
        """Return the motion of the fixed links, seen from the moving ones."""
        return CoupledPath(tuple((line, -rate) for line, rate in reversed(self.steps)), self.length)

    def unturned(self, vector: FloatArray, at: float) -> FloatArray:
        """Turn a world direction at ``at`` back to 0, as if fixed to the moving body."""
        return self.pose(at)[:3, :3].T @ vector

    def orbit(self, points: FloatArray) -> CoupledOrbit:
        """Return how points [m] travel that are at their places at 0; shape [point_count, 3]."""
        return CoupledOrbit(self, points)

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
            radius = np.linalg.norm(line.orbit(points).radial, axis=1) + moved
            acceleration = acceleration + 2.0 * turned * speed + turned**2 * radius
            speed = speed + turned * radius
            moved = moved + min(turned * self.length, 2.0) * radius
        return speed, acceleration


@dataclass(frozen=True)
class CoupledOrbit:
    """Points on such a path.

    Attributes:
        path: theirs.
        start: places at 0 [m], shape [point_count, 3].
    """

    path: CoupledPath
    start: FloatArray

    @cached_property
    def acceleration(self) -> FloatArray:
        """Bound each point's acceleration [m per unit squared], shape [point_count]."""
        return self.path.limits(self.start)[1]

    def highest(self, direction: FloatArray, starts: FloatArray, ends: FloatArray) -> FloatArray:
        """Return what :meth:`.path.Orbit.highest` does, exact where nothing turns."""
        first, last = (self._heights(direction, at) for at in (starts, ends))
        rise = np.outer((ends - starts) ** 2 / 8.0, self.acceleration)
        higher: FloatArray = (np.maximum(first, last) + rise).max(axis=1)
        return higher

    def swept_bounds(self, at: FloatArray) -> FloatArray:
        """Return what :meth:`.path.Orbit.swept_bounds` does."""
        poses = self.path.poses(at)
        points = self.start @ poses[:, :3, :3].transpose(0, 2, 1) + poses[:, None, :3, 3]
        margin = np.diff(at)[:, None] ** 2 / 8.0 * self.acceleration.max()
        return boxed(points, margin)

    def _heights(self, direction: FloatArray, at: FloatArray) -> FloatArray:
        poses = self.path.poses(at)
        lifted = (poses[:, :3, 3] @ direction)[:, None]
        return (direction @ poses[:, :3, :3]) @ self.start.T + lifted


AnyPath = Path | CoupledPath


def swept_boxes(path: AnyPath, points: FloatArray) -> FloatArray:
    """Return boxes around all that points [m] sweep, by interval of the path, [interval, 2, 3]."""
    return path.orbit(points).swept_bounds(np.linspace(0.0, path.length, BOXED_STEPS + 1))
