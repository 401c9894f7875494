"""A moving part to take hold of: its surface, and how a joint moves each point of it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.spatial import QhullError
from trimesh.bounds import oriented_bounds_2D
from trimesh.triangles import closest_point

from ...articulation import Articulation, Joint, JointKind
from ...geometry.triangles import areas_of, doubled_normals
from ...mesh import BoolArray, FloatArray, IntArray, Mesh

#: A part whose centre is this much nearer to its axis than its rim turns on the spot, like a knob.
KNOB_SHARE = 0.25
#: Share of the way from the axis to the rim within which nobody can move anything.
NEAR_HINGE = 0.15


@dataclass(frozen=True)
class PartShape:
    """A part and all that is fixed to it.

    Attributes:
        mesh: of the object, at rest.
        parts: indices of the parts, the one that carries the others first.
        faces: of the mesh, shape [face_count].
    """

    mesh: Mesh
    parts: tuple[int, ...]
    faces: IntArray

    @property
    def part(self) -> int:
        """Return the part that the others are fixed to."""
        return self.parts[0]

    @property
    def welded(self) -> IntArray:
        """Return the vertices of each face, shape [face_count, 3]."""
        return self.mesh.faces[self.faces]

    @cached_property
    def corners(self) -> FloatArray:
        """Return where these are [m], object frame at rest, shape [face_count, 3, 3]."""
        return self.mesh.vertices[self.welded]

    @cached_property
    def areas(self) -> FloatArray:
        """Return the area of each face [m2], shape [face_count]."""
        return areas_of(self.corners)

    @cached_property
    def normals(self) -> FloatArray:
        """Return the outward unit normal of each face, shape [face_count, 3]."""
        return np.asarray(doubled_normals(self.corners) / (2.0 * self.areas[:, None]))

    @property
    def centers(self) -> FloatArray:
        """Return the centre of each face [m], shape [face_count, 3]."""
        return np.asarray(self.corners.mean(axis=1))

    @property
    def center(self) -> FloatArray:
        """Return the centre of the surface [m], shape [3]."""
        return np.asarray(self.areas @ self.centers / self.areas.sum())

    @property
    def middle(self) -> FloatArray:
        """Return the middle of the box around it [m], shape [3]."""
        return middle_of(self.corners)

    def only(self, chosen: IntArray | BoolArray) -> PartShape:
        """Return some of its faces."""
        return replace(self, faces=self.faces[chosen])


@dataclass(frozen=True)
class Moving:
    """A joint and the surface that it moves."""

    joint: Joint
    shape: PartShape

    def pull(self, point: FloatArray) -> FloatArray:
        """Return the unit direction in which opening first moves a point; zero on the axis, [3]."""
        speed = self.joint.velocity(point)
        length = float(np.linalg.norm(speed))
        return np.asarray(speed / length) if length > 1e-6 else np.zeros(3)

    def lever(self, points: FloatArray) -> FloatArray:
        """Return the distance of points, shape [..., 3], from the joint's axis [m]."""
        return np.asarray(
            np.linalg.norm(np.cross(self.joint.axis, points - self.joint.origin), axis=-1)
        )

    @cached_property
    def rim(self) -> float:
        """Return how far the surface reaches from the joint's axis [m]."""
        return float(self.lever(self.shape.corners).max())

    @property
    def spins(self) -> bool:
        """Return whether the middle lies so near the axis that turning takes it nowhere."""
        return bool(
            self.joint.turns and float(self.lever(self.shape.middle)) < KNOB_SHARE * self.rim
        )

    def far_enough(self, points: FloatArray) -> BoolArray:
        """Return which points, [..., 3], are so far from a hinge that a pull moves anything."""
        if not self.joint.turns:
            return np.ones(points.shape[:-1], dtype=bool)
        return np.asarray(self.lever(points) >= NEAR_HINGE * self.rim)

    def place(self, points: FloatArray) -> FloatArray:
        """Rate places to pull, 0 to 1: far from a hinge, near the middle of a drawer.

        Points [m] of shape [..., 3] get one number each.
        """
        if self.joint.turns:
            return np.asarray(self.lever(points) / max(self.rim, 1e-12))
        offset = points - self.shape.middle
        aside = offset - (offset @ self.joint.axis)[..., None] * self.joint.axis
        size = np.ptp(self.shape.corners, axis=(0, 1)).max()
        return np.asarray(1.0 / (1.0 + np.linalg.norm(aside, axis=-1) / size))


def shape_of(articulation: Articulation, part: int) -> PartShape:
    """Return the surface of a part and of those fixed below it; faces without area are left out."""
    carried = {part}
    for joint in articulation.joints:
        if joint.parent in carried and joint.kind is JointKind.FIXED:
            carried.add(joint.child)
    parts = tuple(sorted(carried))
    faces = np.concatenate([articulation.parts[i].faces for i in parts])
    shape = PartShape(articulation.mesh, parts, faces)
    return shape.only(shape.areas > 0.0)


def middle_of(points: FloatArray) -> FloatArray:
    """Return the middle of the box around points, shape [..., 3]; shape [3]."""
    flat = points.reshape(-1, 3)
    return np.asarray((flat.min(axis=0) + flat.max(axis=0)) / 2.0)


def across(vector: FloatArray, normal: FloatArray) -> FloatArray:
    """Return the unit direction of a vector's part across a unit ``normal``, shape [3].

    Zero if hardly any of it lies across.
    """
    rest = vector - (vector @ normal) * normal
    length = float(np.linalg.norm(rest))
    return (
        np.asarray(rest / length) if length > 0.1 * float(np.linalg.norm(vector)) else np.zeros(3)
    )


def nearest_point(triangles: FloatArray, point: FloatArray) -> FloatArray:
    """Return the point of some triangles, shape [n, 3, 3], nearest to ``point`` [m], shape [3]."""
    on_surface = closest_point(triangles, np.tile(point, (len(triangles), 1)))
    # Rounded, so that of triangles as near it is the first, turned as they may be.
    distance = np.round(np.linalg.norm(on_surface - point, axis=1), 9)
    return np.asarray(on_surface[int(distance.argmin())])


def rectangle(points: FloatArray, normal: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the directions of the sides of the least rectangle around points, the narrow first.

    The points [m], shape [..., 3], are seen along a unit ``normal``.
    """
    flat = points.reshape(-1, 3)
    first = across(np.eye(3)[int(np.abs(normal).argmin())], normal)
    basis = np.stack([first, np.cross(normal, first)])
    try:
        to_wide = oriented_bounds_2D(flat @ basis.T)[0]
    except QhullError:
        # All on one line.
        return basis[0], basis[1]
    wide, narrow = to_wide[:2, :2] @ basis
    return narrow, wide
