"""A moving part to take hold of: its surface, and how a joint moves each point of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ...articulation import Articulation, Joint, JointKind
from ...mesh import FloatArray, IntArray

BoolArray = npt.NDArray[np.bool_]

#: A part whose centre is this much nearer to its axis than its rim turns on the spot, like a knob.
KNOB_SHARE = 0.25


@dataclass(frozen=True)
class PartShape:
    """A part and all that is fixed to it.

    Attributes:
        parts: indices of the parts.
        faces: of the mesh, shape [face_count].
        welded: their vertex indices, shape [face_count, 3].
        corners: [m], object frame at rest, shape [face_count, 3, 3].
        normals: outward, unit, shape [face_count, 3].
        areas: [m2], shape [face_count].
    """

    parts: tuple[int, ...]
    faces: IntArray
    welded: IntArray
    corners: FloatArray
    normals: FloatArray
    areas: FloatArray

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
        return np.asarray((self.corners.min(axis=(0, 1)) + self.corners.max(axis=(0, 1))) / 2.0)

    def only(self, chosen: IntArray | BoolArray) -> PartShape:
        """Return some of its faces."""
        return PartShape(
            self.parts,
            self.faces[chosen],
            self.welded[chosen],
            self.corners[chosen],
            self.normals[chosen],
            self.areas[chosen],
        )


def shape_of(articulation: Articulation, part: int) -> PartShape:
    """Return the surface of a part and of those fixed below it; faces without area are left out."""
    carried = {part}
    for joint in articulation.joints:
        if joint.parent in carried and joint.kind is JointKind.FIXED:
            carried.add(joint.child)
    parts = tuple(sorted(carried))
    mesh = articulation.mesh
    faces = np.concatenate([articulation.parts[i].faces for i in parts])
    corners = mesh.vertices[mesh.faces[faces]]
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    double = np.linalg.norm(cross, axis=1)
    real = double > 0.0
    normals = cross[real] / double[real, None]
    return PartShape(
        parts, faces[real], mesh.faces[faces[real]], corners[real], normals, double[real] / 2.0
    )


def velocity(joint: Joint, points: FloatArray) -> FloatArray:
    """Velocity of the part's points per unit of joint speed, opening, at rest; as ``points``."""
    if joint.turns:
        return np.asarray(np.cross(joint.axis, points - joint.origin))
    return np.broadcast_to(joint.axis, points.shape)


def lever(joint: Joint, points: FloatArray) -> FloatArray:
    """Return the distance from the joint's axis [m]."""
    return np.asarray(np.linalg.norm(np.cross(joint.axis, points - joint.origin), axis=-1))


def turns_on_the_spot(joint: Joint, shape: PartShape) -> bool:
    """Return whether the part's middle lies so near the axis that turning takes it nowhere."""
    rim = float(lever(joint, shape.corners).max())
    return bool(joint.turns and float(lever(joint, shape.middle)) < KNOB_SHARE * rim)


def place(joint: Joint, shape: PartShape, points: FloatArray) -> FloatArray:
    """Return how good places to pull are, 0 to 1: far from a hinge, near the middle of a drawer.

    Args:
        joint: moves the shape.
        shape: what is pulled.
        points: [m], shape [..., 3].

    Returns:
        One number for each point, shape [...].
    """
    if joint.turns:
        return np.asarray(
            lever(joint, points) / max(float(lever(joint, shape.corners).max()), 1e-12)
        )
    offset = points - shape.middle
    across = offset - (offset @ joint.axis)[..., None] * joint.axis
    return np.asarray(
        1.0 / (1.0 + np.linalg.norm(across, axis=-1) / np.ptp(shape.corners, axis=(0, 1)).max())
    )
