"""One mesh seen from one side: pieces as boxes, exact rays through the triangles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from ...geometry.edges import label_linked
from ...geometry.triangles import FOLLOWING, doubled_normals, ends_of
from ...mesh import BoolArray, FloatArray, IntArray

FRONT = 1
SIDEWAYS = 0
UP = 2
"""Axes of the view frame: x right, y away from the viewer (the front looks along -y), z up."""
PLAN = [SIDEWAYS, FRONT]
RECT = [SIDEWAYS, UP]
"""Axes of the front plane."""
ALL = [SIDEWAYS, FRONT, UP]


@dataclass(frozen=True)
class Scene:
    """Pieces (connected components) of a mesh in a view frame.

    Attributes:
        triangles: corners in the view frame [m], shape [face_count, 3, 3].
        labels: piece of every face, shape [face_count].
        rotation: view frame from object frame, shape [3, 3]: ``v_view = rotation @ v_object``.
    """

    triangles: FloatArray = field(repr=False)
    labels: IntArray = field(repr=False)
    rotation: FloatArray = field(repr=False)

    @cached_property
    def _ends(self) -> tuple[FloatArray, FloatArray]:
        return ends_of(self.triangles)

    @cached_property
    def _columns(self) -> tuple[FloatArray, FloatArray]:
        # One row per axis: a ray reads three long runs of memory instead of every third number.
        low, high = self._ends
        return np.ascontiguousarray(low.T), np.ascontiguousarray(high.T)

    @cached_property
    def low(self) -> FloatArray:
        """Return the lower box corners of the pieces [m], shape [piece_count, 3]."""
        return self._reduce(np.minimum, self._ends[0])

    @cached_property
    def high(self) -> FloatArray:
        """Return the upper box corners of the pieces [m], shape [piece_count, 3]."""
        return self._reduce(np.maximum, self._ends[1])

    def _reduce(self, operation: np.ufunc, values: FloatArray) -> FloatArray:
        order = np.argsort(self.labels, kind="stable")
        start = np.searchsorted(self.labels[order], np.arange(int(self.labels.max()) + 1))
        return np.asarray(operation.reduceat(values[order], start, axis=0))

    @cached_property
    def extents(self) -> FloatArray:
        """Return the box sides of the pieces [m], shape [piece_count, 3]."""
        return self.high - self.low

    @cached_property
    def middle(self) -> FloatArray:
        """Return the middles of the pieces' boxes [m], shape [piece_count, 3]."""
        return (self.low + self.high) / 2.0

    def square(self, axes: Sequence[int]) -> BoolArray:
        """Return which pieces are as long along one of two axes as along the other, to 6 %."""
        one, other = self.extents[:, axes].T
        return np.asarray(np.abs(one - other) <= 0.06 * np.maximum(one, other))

    @cached_property
    def facing(self) -> FloatArray:
        """Return the area of the pieces projected on the front plane [m2], shape [piece_count]."""
        sides = self.triangles[:, 1:, RECT] - self.triangles[:, :1, RECT]
        doubled = np.abs(_cross(sides[:, 0], sides[:, 1]))
        return np.asarray(np.bincount(self.labels, doubled / 2.0))

    def box_of(self, pieces: IntArray | Sequence[int] | slice) -> FloatArray:
        """Return the box around some pieces [m], shape [2, 3]."""
        return np.stack([self.low[pieces].min(axis=0), self.high[pieces].max(axis=0)])

    @cached_property
    def box(self) -> FloatArray:
        """Return the box of everything [m], shape [2, 3]."""
        return self.box_of(slice(None))

    @cached_property
    def size(self) -> FloatArray:
        """Return the box sides of everything [m], shape [3]."""
        return np.asarray(self.box[1] - self.box[0])

    @property
    def front_area(self) -> float:
        """Return the area of the whole front [m2]."""
        return float(self.size[SIDEWAYS] * self.size[UP])

    @cached_property
    def touch(self) -> float:
        """Return the gap below which pieces touch [m]: 0.4 % of the diagonal."""
        return 0.004 * float(np.linalg.norm(self.size))

    def within(self, low: FloatArray, high: FloatArray, axes: Sequence[int] = ALL) -> BoolArray:
        """Return which pieces are in a box [m] along some axes, shape [piece_count]."""
        inside = (self.low >= low) & (self.high <= high)
        return np.asarray(inside[:, axes].all(axis=1))

    def meeting(self, low: FloatArray, high: FloatArray) -> BoolArray:
        """Return which pieces' boxes meet a box [m], shape [piece_count]."""
        return np.asarray((self.low <= high).all(axis=1) & (self.high >= low).all(axis=1))

    def without(self, pieces: IntArray) -> BoolArray:
        """Return which pieces are none of those given, shape [piece_count]."""
        return ~np.isin(np.arange(len(self.low)), pieces)

    def reading_place(self, low: FloatArray, high: FloatArray) -> tuple[int, float]:
        """Return what sorts boxes [m] from top to bottom, and in a row from left to right."""
        return -round(float(high[UP]) / self.touch), float(low[SIDEWAYS])

    def label_touching(self, pieces: IntArray, gap: float) -> IntArray:
        """Return the group of each piece: boxes a gap [m] apart at most, or linked by others."""
        low = self.low[pieces]
        high = self.high[pieces] + gap
        touching = np.ones((len(pieces), len(pieces)), dtype=bool)
        for axis in range(3):
            touching &= low[:, None, axis] <= high[None, :, axis]
        return label_linked(len(pieces), np.argwhere(touching & touching.T))

    def linked_to(self, pieces: IntArray, start: BoolArray) -> IntArray:
        """Return those of some pieces that touch a started one, directly or through others."""
        labels = self.label_touching(pieces, self.touch)
        return np.asarray(pieces[np.isin(labels, labels[start])])

    def turned(self, rotation: FloatArray) -> Scene:
        """Return the same pieces after another rotation of the view, shape [3, 3]."""
        return Scene(self.triangles @ rotation.T, self.labels, rotation @ self.rotation)

    def distances(
        self, start: FloatArray, ways: Sequence[tuple[int, int]], ignored: IntArray
    ) -> FloatArray:
        """Measure how far it is to what each way meets first [m]; infinite where nothing is.

        Args:
            start: view frame [m], shape [3].
            ways: axis and sign of each.
            ignored: pieces that are gone through.
        """
        return np.array([self.first_hit(start, *way, ignored)[0] for way in ways])

    def first_hit(
        self, origin: FloatArray, axis: int, sign: int, ignored: IntArray
    ) -> tuple[float, int]:
        """Return distance [m] and piece of the first triangle along ``sign * axis``.

        Args:
            origin: view frame [m], shape [3].
            axis: 0, 1 or 2.
            sign: 1 or -1.
            ignored: pieces the ray goes through.

        Returns:
            ``(inf, -1)`` if nothing is hit.
        """
        a = (axis + 1) % 3
        b = (axis + 2) % 3
        low, high = self._columns
        near = (low[a] <= origin[a]) & (high[a] >= origin[a])
        near &= (low[b] <= origin[b]) & (high[b] >= origin[b])
        hit = np.flatnonzero(near)
        hit = hit[~np.isin(self.labels[hit], ignored)]
        corners = self.triangles[hit]
        plane = corners[:, :, [a, b]] - origin[[a, b]]
        opposite = plane[:, FOLLOWING]
        weights = _cross(opposite, opposite[:, FOLLOWING])
        total = weights.sum(axis=1)
        inside = ((weights >= 0).all(axis=1) | (weights <= 0).all(axis=1)) & (np.abs(total) > 0)
        if not inside.any():
            return np.inf, -1
        depth = (weights[inside] * corners[inside, :, axis]).sum(axis=1) / total[inside]
        distance = sign * (depth - origin[axis])
        distance = np.where(distance >= 0, distance, np.inf)
        best = int(np.argmin(distance))
        if not np.isfinite(distance[best]):
            return np.inf, -1
        return float(distance[best]), int(self.labels[hit[inside][best]])


def _cross(p: FloatArray, q: FloatArray) -> FloatArray:
    return np.asarray(p[..., 0] * q[..., 1] - p[..., 1] * q[..., 0])


def quarter_turn(turns: int) -> FloatArray:
    """Return the rotation about z by ``turns`` quarter turns, exact, shape [3, 3]."""
    c, s = ((1, 0), (0, 1), (-1, 0), (0, -1))[turns % 4]
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def level_yaw(triangles: FloatArray) -> float:
    """Return the angle [rad] in (-pi/4, pi/4] of the object's upright faces to the axes.

    The area-weighted circular mean of four times the heading of upright faces: four, since walls
    meet at right angles. Zero when no heading dominates.
    """
    heading, area = headings_of(triangles)
    mean = np.sum(area * np.exp(4j * heading))
    if not len(area) or abs(mean) < 0.5 * area.sum():
        return 0.0
    yaw = float(np.angle(mean)) / 4.0
    return yaw if abs(yaw) > np.radians(0.5) else 0.0


def headings_of(triangles: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return where upright faces look [rad], and twice the area of each [m2], shape [n] both."""
    normals = doubled_normals(triangles)
    area = np.linalg.norm(normals, axis=1)
    upright = np.abs(normals[:, 2]) < 0.2 * area
    return np.arctan2(normals[upright, 1], normals[upright, 0]), area[upright]


def level_frame(triangles: FloatArray) -> FloatArray:
    """Return as rows the level axes along the object's upright faces, and z, shape [3, 3]."""
    yaw = level_yaw(triangles)
    c = np.cos(yaw)
    s = np.sin(yaw)
    return np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
