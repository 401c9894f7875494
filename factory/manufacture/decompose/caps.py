"""Small openings of a surface closed, so that what is nearly a solid is treated as one."""

from __future__ import annotations

import numpy as np
from manifold3d import Manifold

from ...mesh import FloatArray, IntArray
from .solids import OpenSurface, manifold_of

#: Openings up to this share of the surface's area are closed: a pipe's hidden end, not a box's
#: missing lid.
OPENING_SHARE = 0.05


def capped(surface: OpenSurface, share: float = OPENING_SHARE) -> Manifold | None:
    """Return the solid that a surface encloses once its small openings are closed, outward.

    Args:
        surface: an open piece.
        share: of the surface's area that openings may have.

    Returns:
        ``None`` where the openings are more than that, or closing them does not close it.
    """
    loops = boundary_loops(surface.faces)
    if not loops:
        return None
    vertices = [surface.vertices]
    faces = [surface.faces]
    opening = 0.0
    for loop in loops:
        center = surface.vertices[loop].mean(axis=0)
        spokes = surface.vertices[loop] - center
        opening += (
            float(np.linalg.norm(np.cross(spokes, np.roll(spokes, -1, axis=0)), axis=1).sum()) / 2.0
        )
        apex = len(surface.vertices) + len(vertices) - 1
        vertices.append(center[None])
        faces.append(np.column_stack([np.roll(loop, -1), loop, np.full(len(loop), apex)]))
    if opening > share * _area(surface.vertices, surface.faces):
        return None
    solid = manifold_of(np.concatenate(vertices), np.concatenate(faces))
    if solid is None:
        return None
    if solid.volume() < 0.0:
        solid = manifold_of(np.concatenate(vertices), np.concatenate(faces)[:, ::-1])
    return solid


def _area(vertices: FloatArray, faces: IntArray) -> float:
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return float(np.linalg.norm(normals, axis=1).sum()) / 2.0


def boundary_loops(faces: IntArray) -> list[IntArray]:
    """Vertices around each opening, in the direction of the faces beside it; empty if not loops."""
    starts = faces.ravel()
    ends = np.roll(faces, -1, axis=1).ravel()
    forward = set(zip(starts.tolist(), ends.tolist(), strict=True))
    border = sorted((a, b) for a, b in forward if (b, a) not in forward)
    following = dict(border)
    if len(following) != len(border) or set(following) != set(following.values()):
        # Two openings meet in a vertex: which edge follows which is a guess.
        return []
    loops = []
    while following:
        start = min(following)
        loop = [start]
        while (after := following.pop(loop[-1])) != start:
            loop.append(after)
        loops.append(np.array(loop, dtype=np.int64))
    return loops
