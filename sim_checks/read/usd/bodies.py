"""A rigid body of a USD stage, in its own frame."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...description import DescriptionError, FloatArray, LinkInertia
from ...geometry.placing import rigid

#: Everything that is part of no rigid body, and what a joint without a body holds on to.
WORLD = "/"


@dataclass(frozen=True)
class PhysicsBody:
    """A rigid body.

    Attributes:
        path: of its prim.
        pose: of its frame in the world, without scale [m], shape [4, 4].
        scale: of its own lengths, shape [3].
        inertia: ``None`` where the file gives no mass.
    """

    path: str
    pose: FloatArray
    scale: FloatArray
    inertia: LinkInertia | None = None


def rotation_of(quaternion: Any) -> FloatArray:
    """Return the rotation of a USD quaternion of any length; none for none or zero. Shape [3, 3].

    Raises:
        DescriptionError: ``not_finite``.
    """
    from scipy.spatial.transform import Rotation

    if quaternion is None:
        return np.eye(3)
    parts = np.array([*quaternion.GetImaginary(), quaternion.GetReal()], dtype=np.float64)
    if not np.isfinite(parts).all():
        raise DescriptionError("not_finite", f"a rotation is {parts.tolist()}, want finite numbers")
    return np.asarray(Rotation.from_quat(parts).as_matrix()) if parts.any() else np.eye(3)


def split_scale(pose: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the nearest pose without scale, shape [4, 4], and the scale, shape [3].

    Raises:
        DescriptionError: ``not_finite``.
    """
    scale = np.linalg.norm(pose[:3, :3], axis=0)
    if not (np.isfinite(pose).all() and (scale > 0.0).all()):
        raise DescriptionError("not_finite", "a body's place is not finite, or its scale is 0")
    u, _, v = np.linalg.svd(pose[:3, :3] / scale)
    turn = u @ np.diag([1.0, 1.0, float(np.sign(np.linalg.det(u @ v)))]) @ v
    return rigid(turn, pose[:3, 3]), scale
