"""A rigid body of a USD stage, in its own frame."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...description import FloatArray, LinkInertia
from .shapes import PhysicsSurface

#: Everything that is part of no rigid body, and what a joint without a body holds on to.
WORLD = "/"


@dataclass
class PhysicsBody:
    """A rigid body.

    Attributes:
        path: of its prim.
        pose: of its frame in the world, without scale [m], shape [4, 4].
        scale: of its own lengths, shape [3].
        inertia: ``None`` where the file gives no mass.
        visuals, collisions: surfaces in its frame [m].
    """

    path: str
    pose: FloatArray
    scale: FloatArray
    inertia: LinkInertia | None = None
    visuals: list[PhysicsSurface] = field(default_factory=list)
    collisions: list[PhysicsSurface] = field(default_factory=list)


def rotation_of(quaternion: Any) -> FloatArray:
    """Return the rotation of a USD quaternion; none for none or zero. Shape [3, 3]."""
    from scipy.spatial.transform import Rotation

    if quaternion is None:
        return np.eye(3)
    parts = np.array([*quaternion.GetImaginary(), quaternion.GetReal()], dtype=np.float64)
    if not np.linalg.norm(parts) > 0.0 or not np.isfinite(parts).all():
        return np.eye(3)
    return np.asarray(Rotation.from_quat(parts).as_matrix())
