"""How large faces are."""

from __future__ import annotations

import numpy as np

from ..mesh import FloatArray, Mesh


def face_areas(mesh: Mesh) -> FloatArray:
    """Area of every face [m2], shape [face_count]."""
    a, b, c = (mesh.vertices[mesh.faces[:, corner]] for corner in range(3))
    return np.asarray(np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2.0)
