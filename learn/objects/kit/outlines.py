"""Lines in a plane [m], shape [count, 2]: arcs, ovals, rectangles with round corners."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import numpy.typing as npt

from asset_factory.factory.mesh import FloatArray

from .axes import Z
from .spans import Flat, Span, size, within


@lru_cache(maxsize=64)
def circle(sides: int) -> FloatArray:
    """Return the cosines and sines of a regular polygon's corners, shape [2, sides]."""
    # Half a step makes a square of four corners upright.
    angle = 2.0 * np.pi * (np.arange(sides) + 0.5) / sides
    return np.stack([np.cos(angle), np.sin(angle)])


def arc(center: Flat, radius: float, start: float, stop: float, count: int) -> FloatArray:
    """Return points on a circle, shape [count, 2], between two angles [rad], both included."""
    angle = np.linspace(start, stop, count)
    return np.stack([np.cos(angle), np.sin(angle)], axis=1) * radius + center


def oval(half_x: float, half_y: float, count: int = 28) -> FloatArray:
    """Return the points on an ellipse about the origin, shape [count, 2]."""
    return circle(count).T * (half_x, half_y)


def raised(line: npt.ArrayLike, height: float, axis: int = Z) -> FloatArray:
    """Return a line at a height along the axis across its plane, shape [count, 3]."""
    return np.insert(np.asarray(line, dtype=np.float64), axis, height, axis=1)


@lru_cache(maxsize=16)
def _quarters(steps: int) -> FloatArray:
    return np.concatenate(
        [arc((0.0, 0.0), 1.0, k * np.pi / 2, (k + 1) * np.pi / 2, steps) for k in range(4)]
    )


def rounded(x: Span, y: Span, radius: float, steps: int = 4) -> FloatArray:
    """Return a rectangle with rounded corners, counter-clockwise, shape [4 steps, 2]."""
    r = min(radius, 0.499 * size(x), 0.499 * size(y))
    left, right = within(x, r)
    near, far = within(y, r)
    centers = np.array(((right, far), (left, far), (left, near), (right, near)))
    return np.repeat(centers, steps, axis=0) + r * _quarters(steps)
