"""Points spread over a surface, always the same ones."""

from __future__ import annotations

import numpy as np

from ...geometry.triangles import face_areas
from ...mesh import FloatArray, Mesh

#: Points spread over a part's visible surface, by area; its corners are looked at besides.
SPREAD = 1500


def spread_over(mesh: Mesh, most_corners: int) -> FloatArray:
    """Return points over a surface [m], shape [n, 3]: :data:`SPREAD` by area, then corners.

    Those by area stand for equal areas each; of more than ``most_corners`` so many are drawn. No
    points where there is no area. All vertices must be used.
    """
    generator = np.random.default_rng(0)
    areas = face_areas(mesh)
    if not areas.sum() > 0.0:
        return np.zeros((0, 3))
    chosen = generator.choice(len(areas), SPREAD, p=areas / areas.sum())
    u, v = np.sort(generator.random((2, SPREAD)), axis=0)
    a, b, c = np.moveaxis(mesh.vertices[mesh.faces[chosen]], 1, 0)
    spread = u[:, None] * a + (v - u)[:, None] * b + (1.0 - v)[:, None] * c
    corners = mesh.vertices
    if len(corners) > most_corners:
        corners = corners[generator.choice(len(corners), most_corners, replace=False)]
    return np.concatenate([spread, corners])
