"""Open surfaces that nobody reaches into, as one hull: knobs, caps, panels without a back."""

from __future__ import annotations

import numpy as np

from ...asset import Hull
from ...mesh import FloatArray
from .caps import boundary_loops
from .convex import concavity, hull_of, thickness
from .room import Room
from .solids import OpenSurface

#: A hand is a ball of this diameter [m]: it gets into no narrower opening.
HAND_M = 0.06
#: Openings that look up further than this hold things, however shallow [cosine].
UPWARD = 0.7


def as_shell(surface: OpenSurface, error_m: float, room: Room) -> Hull | None:
    """The hull of an open surface that lies close below it, where what is filled matters to nobody.

    Args:
        surface: an open piece.
        error_m: deepest dent of the surface itself that may be filled [m].
        room: that other parts take.

    Returns:
        ``None`` where the surface is not convex, where a hand gets in, or another part is in it.
    """
    hull = hull_of(surface.vertices)
    if hull is None or concavity(surface.vertices, surface.faces, hull) > error_m:
        return None
    shallow = thickness(hull.vertices, hull.planes) <= HAND_M / 2.0 and not opens_up(surface)
    if not shallow and not narrow_openings(surface):
        return None
    return None if room.entered(hull) else hull


def narrow_openings(surface: OpenSurface) -> bool:
    """Return whether no hand gets in through any opening of a surface."""
    loops = boundary_loops(surface.faces)
    return bool(loops) and all(_width(surface.vertices[loop]) < HAND_M for loop in loops)


def opens_up(surface: OpenSurface) -> bool:
    """Return whether it is open towards the top, as a tray is, whichever way it is wound."""
    corners = surface.vertices[surface.faces]
    vectors = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2.0
    middle = (surface.vertices.min(axis=0) + surface.vertices.max(axis=0)) / 2.0
    outward = float(np.einsum("ij,ij->", corners.mean(axis=1) - middle, vectors))
    opening = -vectors.sum(axis=0) * (1.0 if outward >= 0.0 else -1.0)
    length = float(np.linalg.norm(opening))
    return length > 0.0 and float(opening[2]) > UPWARD * length


def _width(points: FloatArray) -> float:
    """Of a loop across its longest direction, in its own plane [m]."""
    centered = points - points.mean(axis=0)
    _, _, axes = np.linalg.svd(centered, full_matrices=False)
    extents = np.sort(np.ptp(centered @ axes.T, axis=0))
    return float(extents[-2])
