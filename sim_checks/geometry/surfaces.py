"""Visible meshes as triangle soups: open, doubled, turned inside out, of any size."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from ..description import FloatArray, IntArray
from .collision import Skin
from .placing import box_around, box_corners, grow_box

#: Corners closer than this are one [m].
WELD = 1e-6
#: Odd factors that spread three coordinates over one 64-bit number.
MIXING = np.array([0x2545F4914F6CDD1D, 0x1B873593CC9E2D51, 0x5851F42D4C957F2D], dtype=np.int64)


@dataclass(frozen=True)
class SurfaceMeeting:
    """Where two hulls meet.

    Attributes:
        box: around their common region [m], world frame, shape [2, 3].
        depth: of the hulls [m]; 0 or less where they do not meet.
        direction: from the first hull into the second, unit, world frame, shape [3].
        margin: how far around the box to look [m]; wider gaps are not measured.
    """

    box: FloatArray
    depth: float
    direction: FloatArray
    margin: float


@dataclass(frozen=True)
class VisibleSurface:
    """The triangles of a shape, or of all that one part shows, in their own frame.

    Attributes:
        vertices: [m], shape [vertex_count, 3].
        faces: shape [face_count, 3].
    """

    vertices: FloatArray
    faces: IntArray

    @cached_property
    def boxes(self) -> FloatArray:
        """Return the lowest and highest corner of every face [m], shape [2, face_count, 3]."""
        corners = self.vertices[self.faces]
        return np.stack([corners.min(axis=1), corners.max(axis=1)])

    @cached_property
    def areas(self) -> FloatArray:
        """Return the area of every face [m2], shape [face_count]."""
        a, b, c = (self.vertices[self.faces[:, k]] for k in range(3))
        areas: FloatArray = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
        return areas

    @property
    def volume(self) -> float:
        """Return the volume by the divergence theorem [m3]; means something only if it is closed.

        Negative where the faces look inwards.
        """
        a, b, c = (self.vertices - self.vertices.mean(axis=0))[self.faces].transpose(1, 0, 2)
        return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0)

    @cached_property
    def welded(self) -> IntArray:
        """Return the faces by corners merged where they are in one place, shape [face_count, 3]."""
        # Three numbers to one by odd factors: sorting rows is slow, and a clash as likely as a
        # lightning strike.
        keys = (np.round(self.vertices / WELD).astype(np.int64) * MIXING).sum(axis=1)
        _, merged = np.unique(keys, return_inverse=True)
        return merged.ravel()[self.faces].astype(np.int64)

    @cached_property
    def pieces(self) -> IntArray:
        """Return for each face the number of its connected piece, shape [face_count]."""
        faces = self.welded
        count = int(faces.max()) + 1
        start = np.concatenate([faces[:, 0], faces[:, 1]])
        end = np.concatenate([faces[:, 1], faces[:, 2]])
        graph = coo_matrix((np.ones(len(start), dtype=np.int8), (start, end)), shape=(count, count))
        labels: IntArray = connected_components(graph, directed=False)[1].astype(np.int64)
        return labels[faces[:, 0]]

    def closed(self, rows: IntArray) -> bool:
        """Return whether the faces are closed: every edge runs as often one way as the other."""
        faces = self.welded[rows]
        edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
        edges = edges[edges[:, 0] != edges[:, 1]]
        low = edges.min(axis=1)
        sign = np.where(edges[:, 0] < edges[:, 1], 1, -1)
        _, which = np.unique(low * (int(faces.max()) + 1) + edges.max(axis=1), return_inverse=True)
        return not np.bincount(which, weights=sign).any()


@dataclass(frozen=True)
class PosedSurface:
    """A surface in the world.

    Attributes:
        surface: in its own frame.
        pose: of that frame, shape [4, 4].
    """

    surface: VisibleSurface
    pose: FloatArray

    def patch(self, box: FloatArray) -> Patch | None:
        """Return the faces whose boxes reach into a box of the world [m]; ``None`` without any."""
        surface = self.surface
        turn = self.pose[:3, :3]
        place = self.pose[:3, 3]
        local = (box_corners(box) - place) @ turn
        below, above = surface.boxes
        near = ((below <= local.max(axis=0)) & (above >= local.min(axis=0))).all(axis=1)
        rows = np.flatnonzero(near)
        corners = surface.vertices[surface.faces[rows]] @ turn.T + place
        inside = ((corners.min(axis=1) <= box[1]) & (corners.max(axis=1) >= box[0])).all(axis=1)
        return Patch(self, rows[inside], corners[inside]) if inside.any() else None


@dataclass(frozen=True)
class Patch:
    """Some faces of a surface in the world.

    Attributes:
        whole: whose.
        rows: which faces.
        corners: theirs in the world [m], shape [len(rows), 3, 3].
    """

    whole: PosedSurface
    rows: IntArray
    corners: FloatArray

    @cached_property
    def skin(self) -> Skin:
        """Return the same, ready to be asked what it meets."""
        return Skin(self.corners.reshape(-1, 3), np.arange(3 * len(self.rows)).reshape(-1, 3))


def patches(
    first: PosedSurface, second: PosedSurface, meeting: SurfaceMeeting
) -> tuple[Patch | None, Patch | None]:
    """Return what the two surfaces show around a meeting; ``None`` where one shows nothing.

    The first is of the part whose hull is first in the meeting.
    """
    box = grow_box(meeting.box, meeting.margin)
    one = first.patch(box)
    other = second.patch(box)
    if one is None or other is None:
        return one, other
    # Neither matters where the other is not.
    around = (grow_box(box_around([each.corners]), meeting.margin) for each in (one, other))
    lows, highs = np.stack([box, *around], axis=1)
    box = np.array([lows.max(axis=0), highs.min(axis=0)])
    return first.patch(box), second.patch(box)
