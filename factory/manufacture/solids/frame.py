"""A frame along whose axes an object's panels lie: the object's own, turned about the vertical."""

import numpy as np

from ...articulation import Articulation, rotation_about
from ...asset import Hull
from ...geometry.triangles import doubled_normals
from ...mesh import FloatArray

#: Smaller angles are those of faces, not of the object [rad].
LEAST_TURN = np.radians(1.5)
#: Normals count that are at least this level.
LEVEL = 0.3


def working_frame(articulation: Articulation, parts: tuple[int, ...]) -> FloatArray:
    """Return the frame (rows) along whose axes most upright faces of some parts look, [3, 3]."""
    mesh = articulation.mesh
    faces = np.concatenate([articulation.parts[part].faces for part in parts])
    corners = mesh.vertices[mesh.faces[faces]]
    normals = doubled_normals(corners)
    area = np.linalg.norm(normals, axis=1)
    upright = np.abs(normals[:, 2]) < LEVEL * area
    normals = normals[upright]
    # Four times the angle is one for faces a quarter turn apart; large faces count squared.
    angle = np.arctan2(normals[:, 1], normals[:, 0]) * 4.0
    weight = area[upright]
    if not weight.sum() > 0.0:
        return np.eye(3)
    total = np.sum(weight * np.exp(1j * angle))
    turn = float(np.angle(total)) / 4.0
    strength = float(np.abs(total)) / float(weight.sum())
    if abs(turn) < LEAST_TURN or strength < 0.5:
        return np.eye(3)
    return rotation_about([0.0, 0.0, 1.0], -turn)


def turned_hull(hull: Hull, rotation: FloatArray) -> Hull:
    """Return a hull turned, or mirrored, by ``rotation``, shape [3, 3]."""
    if np.array_equal(rotation, np.eye(3)):
        return hull
    faces = hull.faces[:, ::-1] if np.linalg.det(rotation) < 0.0 else hull.faces
    return Hull(hull.vertices @ rotation.T, faces)
