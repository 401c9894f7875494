"""Fewer triangles, still a closed manifold, hardly moved."""

from __future__ import annotations

import numpy as np
from manifold3d import Manifold

from ...config import DecomposeConfig
from ...mesh import FloatArray, IntArray
from .solids import OpenSurface, manifold_of, triangles_of

#: The volume may change by this share when triangles are taken away, and pieces may leave as much
#: of a solid uncovered.
VOLUME_SHARE = 0.02
#: How far the surface may move when a solid is smoothed, as a share of the error.
SMOOTHING_SHARE = 0.1


def smoothed(solid: Manifold, error_m: float, config: DecomposeConfig) -> Manifold:
    """Return a solid simplified as far as the error of its hulls [m] allows.

    It has about as many triangles as CoACD may be given; more where it would not stay closed. In
    the first, exact step its surface moves by no more than :data:`SMOOTHING_SHARE` of the error.
    """
    light = _accepted(solid.simplify(SMOOTHING_SHARE * error_m), solid) or solid
    if light.num_tri() <= config.max_faces:
        return light
    again = manifold_of(*_decimated(*triangles_of(light), config.max_faces))
    return (again and _accepted(again, solid)) or light


def lighter(surface: OpenSurface, max_faces: int) -> OpenSurface:
    """Return an open surface with about ``max_faces`` triangles."""
    if len(surface.faces) <= max_faces:
        return surface
    vertices, faces = _decimated(surface.vertices, surface.faces, max_faces)
    return OpenSurface(vertices, faces) if len(faces) else surface


def _decimated(
    vertices: FloatArray, faces: IntArray, max_faces: int
) -> tuple[FloatArray, IntArray]:
    import fast_simplification

    # The library's default aggression of 7 opens thin walls.
    fewer, reduced = fast_simplification.simplify(vertices, faces, target_count=max_faces, agg=3)
    return np.array(fewer, dtype=np.float64), np.array(reduced, dtype=np.int64)


def _accepted(candidate: Manifold, original: Manifold) -> Manifold | None:
    change = abs(candidate.volume() - original.volume())
    return candidate if candidate.num_tri() and change <= VOLUME_SHARE * original.volume() else None
