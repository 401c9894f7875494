"""The whole object around a hand: the surface in a box, exactly."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import chain

import numpy as np
import numpy.typing as npt

from ...articulation import Articulation
from ...asset import Hull
from ...geometry.cutting import clip_to_box
from ...geometry.posing import face_parts
from ...geometry.triangles import ends_of, meet_box
from ...mesh import BoolArray, FloatArray, IntArray
from ..decompose.convex import THINNEST_M, depth_below


@dataclass(frozen=True)
class Surroundings:
    """Everything that a hand may meet, object frame at rest.

    Attributes:
        triangles: visible surfaces and collision hulls [m], shape [triangle_count, 3, 3].
        parts: whose each one is, shape [triangle_count].
        hulls: all of them.
    """

    triangles: FloatArray
    parts: IntArray
    hulls: tuple[Hull, ...]

    @cached_property
    def boxes(self) -> tuple[FloatArray, FloatArray]:
        """Lower and upper corners of each triangle's box [m], shapes [triangle_count, 3]."""
        return ends_of(self.triangles)

    @cached_property
    def bounds(self) -> FloatArray:
        """Return the box around everything [m], shape [2, 3]."""
        return np.stack([self.boxes[0].min(axis=0), self.boxes[1].max(axis=0)])

    @cached_property
    def hull_boxes(self) -> FloatArray:
        """Return the box around each hull [m], shape [hull_count, 2, 3]."""
        return np.reshape([hull.bounds for hull in self.hulls], (-1, 2, 3))

    def is_inside(self, point: FloatArray) -> bool:
        """Return whether a point [m], shape [3], lies within a hull, deeper than a touch."""
        low, high = np.moveaxis(self.hull_boxes, 1, 0)
        # Most hulls are nowhere near, and asking all of their planes is what takes long.
        near = np.flatnonzero(((low <= point) & (high >= point)).all(axis=1)).tolist()
        return any(depth_below(self.hulls[hull], point[None])[0] > THINNEST_M for hull in near)


def surroundings_of(articulation: Articulation, hulls: Sequence[Sequence[Hull]]) -> Surroundings:
    """Gather the meshes and hulls of all parts, at rest; of some only the mesh is known."""
    mesh = articulation.mesh
    corners = [mesh.vertices[mesh.faces]]
    owners = [face_parts(articulation)]
    for part, pieces in enumerate(hulls):
        corners += [hull.vertices[hull.faces] for hull in pieces]
        owners += [np.full(len(hull.faces), part) for hull in pieces]
    solid = tuple(chain.from_iterable(hulls))
    return Surroundings(np.concatenate(corners), np.concatenate(owners), solid)


@dataclass(frozen=True)
class HandView:
    """The surroundings of a point, in a frame of a hand there.

    Attributes:
        everything: where the triangles come from.
        point: the frame's origin [m], shape [3].
        axes: the frame's axes as rows, shape [3, 3].
        near: triangles near the point, object frame [m], shape [near_count, 3, 3].
        own: which of them belong to the held part, shape [near_count].
    """

    everything: Surroundings
    point: FloatArray
    axes: FloatArray
    near: FloatArray
    own: BoolArray

    def turned(self, axes: FloatArray) -> HandView:
        """Return the same surroundings in a frame with other axes (rows)."""
        return replace(self, axes=axes)

    @cached_property
    def _local(self) -> FloatArray:
        """Return the triangles in the frame [m], shape [near_count, 3, 3]."""
        return np.asarray((self.near - self.point) @ self.axes.T)

    @cached_property
    def _boxes(self) -> tuple[FloatArray, FloatArray]:
        return ends_of(self._local)

    def _met(self, low: FloatArray, high: FloatArray) -> BoolArray:
        """Return the triangles whose boxes meet a box."""
        below, above = self._boxes
        return np.asarray(((above >= low) & (below <= high)).all(axis=1))

    def free(self, lowest: npt.ArrayLike, highest: npt.ArrayLike) -> bool:
        """Return whether nothing lies in a box of the frame, between two corners [m].

        What only touches a box is not in it.
        """
        low = np.asarray(lowest) + THINNEST_M
        high = np.asarray(highest) - THINNEST_M
        if (high <= low).any():
            return True
        met = self._local[self._met(low, high)]
        # Most boxes that are not free hold a corner, which is soon seen.
        if len(met) and (
            ((met >= low) & (met <= high)).all(axis=2).any() or meet_box(met, low, high).any()
        ):
            return False
        # Of a box that no surface meets all lies within a hull, or nothing.
        return not self.everything.is_inside(self.point + (low + high) / 2.0 @ self.axes)

    def within(self, lowest: npt.ArrayLike, highest: npt.ArrayLike) -> FloatArray:
        """Return the own geometry in a box of the frame: triangles cut to it [m], [any, 3, 3]."""
        low = np.asarray(lowest)
        high = np.asarray(highest)
        return clip_to_box(self._local[self.own & self._met(low, high)], low, high)

    def spans(self, low: npt.ArrayLike, high: npt.ArrayLike, gap: float) -> FloatArray:
        """Return what of the own geometry lies in a box, along the first axis.

        Returns:
            Lower and upper ends [m] of intervals further apart than ``gap``, in order, shape
            [span_count, 2].
        """
        along = self.within(low, high)[:, :, 0]
        if not len(along):
            return np.zeros((0, 2))
        least, most = ends_of(along)
        order = np.argsort(least, kind="stable")
        starts = least[order]
        ends = np.maximum.accumulate(most[order])
        new = np.concatenate([[True], starts[1:] > ends[:-1] + gap])
        last = np.concatenate([new[1:], [True]])
        return np.stack([starts[new], ends[last]], axis=1)
