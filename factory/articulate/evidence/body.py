"""One part in its surroundings: everything that the evidence about its motion is read from."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from ...geometry.components import connected_components
from ...geometry.cutting import divide
from ...geometry.triangles import ends_of
from ...mesh import BoolArray, FloatArray, IntArray, Mesh, freeze
from ..geometric.scene import level_frame
from .frames import distinct, own_frame
from .grid import Grid, grid_around
from .surfels import WHOLE, Surfels, spread, spread_owned

#: Surfels of a part.
PART_SURFELS = 512
#: Points that are moved to see what they meet.
PROBES = 96
#: Surroundings within this share of the part's diagonal are looked at.
REACH = 0.6
#: A gap up to this share of the object's diagonal is contact.
CONTACT = 0.01
#: Share of the part's surface that lies in a plane before the plane is one of its faces.
FLAT = 0.1


@dataclass(frozen=True)
class Partition:
    """A mesh whose faces are shared out among parts, and which part hangs on which.

    Attributes:
        mesh: metres, z up.
        face_part: part of every face, shape [face_count].
        parents: part that each part hangs on, -1 for the root, shape [part_count].
    """

    mesh: Mesh = field(repr=False)
    face_part: IntArray
    parents: IntArray

    def __post_init__(self) -> None:
        freeze(self, "face_part", "parents", dtype=np.int64)
        if self.face_part.shape != (len(self.mesh.faces),):
            raise ValueError(
                f"partition: {self.face_part.shape} labels for {len(self.mesh.faces)} faces"
            )
        if len(self.face_part) and not 0 <= self.face_part.min() <= self.face_part.max() < len(
            self.parents
        ):
            raise ValueError(f"partition: a label is outside 0..{len(self.parents) - 1}")

    @cached_property
    def triangles(self) -> FloatArray:
        """Return the corners [m], shape [face_count, 3, 3]."""
        return np.asarray(self.mesh.vertices[self.mesh.faces])

    @cached_property
    def few_vertices(self) -> FloatArray:
        """Return enough of the mesh's vertices to tell its extents from [m], shape [n, 3]."""
        return np.asarray(self.mesh.vertices[:: max(1, len(self.mesh.vertices) // 4000)])

    @cached_property
    def ends(self) -> tuple[FloatArray, FloatArray]:
        """Return the box corners of every face [m], two of shape [face_count, 3]."""
        return ends_of(self.triangles)

    @cached_property
    def level(self) -> FloatArray:
        """Return the object's level frame, see :func:`~..geometric.scene.level_frame`."""
        return level_frame(self.triangles)

    @cached_property
    def components(self) -> IntArray:
        """Return the connected component of every face, shape [face_count]."""
        return connected_components(self.mesh)

    def above(self, part: int) -> IntArray:
        """Return what the part hangs on, directly or not, nearest first."""
        found: list[int] = []
        at = int(self.parents[part])
        while at >= 0 and at not in found:
            found.append(at)
            at = int(self.parents[at])
        return np.array(found, dtype=np.int64)

    def subtree(self, part: int) -> IntArray:
        """Return the part and all that hangs on it, directly or not."""
        parts = range(len(self.parents))
        return np.array([each for each in parts if each == part or part in self.above(each)])


@dataclass(frozen=True)
class Body:
    """A part that is to be moved, and what stays.

    Attributes:
        partition: whose part.
        part: its index.
        own: surfels of the part alone.
        moving: surfels of the part and all that hangs on it.
        grid: of what stays around it.
        held: surfels of what it hangs on alone, among those of ``grid``.
        frames: right-angled frames to look for edges in, the object's level one first.
        diagonal: of the part's box [m].
    """

    partition: Partition = field(repr=False)
    part: int
    own: Surfels = field(repr=False)
    moving: Surfels = field(repr=False)
    grid: Grid = field(repr=False)
    held: Surfels = field(repr=False)
    frames: tuple[FloatArray, ...]
    diagonal: float

    @property
    def tolerance(self) -> float:
        """Return the gap below which the part touches what stays [m]."""
        return CONTACT * self.partition.mesh.diagonal

    @cached_property
    def faces(self) -> IntArray:
        """Return the faces of the part alone."""
        return np.flatnonzero(self.partition.face_part == self.part)

    @cached_property
    def corners(self) -> FloatArray:
        """Return the part's own vertices [m], shape [n, 3]."""
        return np.asarray(self.partition.triangles[self.faces].reshape(-1, 3))

    @cached_property
    def tree(self) -> cKDTree | None:
        """Return a tree of the points that stay; ``None`` if nothing is near."""
        points = self.grid.surfels.points
        return cKDTree(points[:: max(1, len(points) // 6000)]) if len(points) else None

    @cached_property
    def gaps(self) -> FloatArray:
        """Measure from each of the part's surfels to what stays [m], inf for none, [n]."""
        if self.tree is None:
            return np.full(len(self.own), np.inf)
        return np.asarray(self.tree.query(self.own.points)[0])

    @cached_property
    def contact(self) -> Surfels:
        """Return the part's own surfels that touch what stays, or the nearest ones."""
        nearest = float(self.gaps.min(initial=np.inf))
        if not np.isfinite(nearest):
            return self.own
        near = self.gaps <= max(nearest + 0.5 * self.tolerance, self.tolerance)
        return self.own.at(near)

    @cached_property
    def holder(self) -> Grid:
        """Return the grid of what the part hangs on alone: neighbours that move can make way."""
        if not len(self.held) or len(self.held) == len(self.grid.surfels):
            return self.grid
        size = self.grid.cell * np.array(self.grid.tenant.shape)
        return grid_around(self.held, self.grid.low, self.grid.low + size)

    @property
    def crowded(self) -> bool:
        """Tell whether anything besides its holder is near: ``holder`` differs from ``grid``."""
        return self.holder is not self.grid

    def heavy_planes(self, direction: FloatArray, low: float) -> list[float]:
        """Return the first and the last plane across a direction with much of the surface [m].

        Args:
            direction: a unit vector, shape [3].
            low: from where planes are counted along it [m].

        Returns:
            Two places along the direction; nothing where no plane is one of the part's faces.
        """
        flat = self.own.points[self.own.facing(direction)] @ direction
        bins = np.maximum((flat - low) / max(0.015 * self.diagonal, 1e-9), 0.0).astype(np.int64)
        heavy = np.flatnonzero(np.bincount(bins) >= FLAT * len(self.own))
        return [float(np.median(flat[bins == at])) for at in heavy[[0, -1]]] if len(heavy) else []

    @cached_property
    def probes(self) -> Surfels:
        """Return few surfels of all that moves."""
        return self.moving.some(PROBES)


def body_of(partition: Partition, part: int) -> Body | None:
    """Return the part as a body; ``None`` if it has no surface, or nothing stays."""
    own_faces = partition.face_part == part
    moving_faces = np.isin(partition.face_part, partition.subtree(part))
    own = spread(partition.triangles[own_faces], PART_SURFELS)
    if not len(own) or moving_faces.all():
        return None
    low = partition.ends[0][moving_faces].min(axis=0)
    high = partition.ends[1][moving_faces].max(axis=0)
    diagonal = float(np.linalg.norm(high - low))
    low = low - REACH * diagonal
    high = high + REACH * diagonal
    rest, owner = _near(partition, ~moving_faces, low, high)
    bounds = partition.mesh.bounds
    low = np.maximum(low, bounds[0] - 0.01 * diagonal)
    high = np.minimum(high, bounds[1] + 0.01 * diagonal)
    surfels, triangle = spread_owned(rest, WHOLE)
    inside = ((surfels.points >= low) & (surfels.points < high)).all(axis=1)
    surfels = surfels.at(inside)
    grid = grid_around(surfels, low, high)
    held = surfels.at(np.isin(owner[triangle[inside]], partition.above(part)))
    moving = (
        own
        if moving_faces.sum() == own_faces.sum()
        else spread(partition.triangles[moving_faces], PART_SURFELS)
    )
    mine = own_frame(own)
    frames = distinct([partition.level, *([] if mine is None else [mine])])
    return Body(partition, part, own, moving, grid, held, tuple(frames), diagonal)


def _near(
    partition: Partition, stays: BoolArray, low: FloatArray, high: FloatArray
) -> tuple[FloatArray, IntArray]:
    """Return the triangles that reach into a box, shape [n, 3, 3], and their parts, shape [n].

    Large ones are cut up, so that surfels are not spent outside.
    """
    face_low, face_high = partition.ends
    near = stays & (face_low <= high).all(axis=1) & (face_high >= low).all(axis=1)
    triangles = partition.triangles[near]
    owner = partition.face_part[near]
    longest = 0.5 * float((high - low).max())
    small: list[FloatArray] = []
    owners: list[IntArray] = []
    for _ in range(8):
        large = (np.ptp(triangles, axis=1) > longest).any(axis=1)
        small.append(triangles[~large])
        owners.append(owner[~large])
        if not large.any():
            break
        triangles = triangles[large]
        halves = np.full((len(triangles), 3), 0.5)
        quarters = divide(halves > 0.0, halves)
        triangles = quarters.spread(triangles)
        owner = owner[large][quarters.whole]
        below, above = ends_of(triangles)
        inside = ((below <= high) & (above >= low)).all(axis=1)
        triangles = triangles[inside]
        owner = owner[inside]
    return np.concatenate(small), np.concatenate(owners)
