"""Openings of a surface: small ones are closed, and what nobody reaches into is one hull."""

from __future__ import annotations

import numpy as np
from manifold3d import Manifold

from ...asset import Hull
from ...geometry.triangles import areas_of, doubled_normals
from ...mesh import FloatArray, IntArray
from .convex import concavity, hull_of, thickness
from .room import Room
from .solids import OpenSurface, manifold_of

#: Openings up to this share of the surface's area are closed: a pipe's hidden end, not a box's
#: missing lid.
OPENING_SHARE = 0.05
#: Narrow openings up to this one.
NARROW_SHARE = 0.35
#: A hand is a ball of this diameter [m]: it gets into no narrower opening.
HAND_M = 0.06
#: Openings that look up further than this hold things, however shallow [cosine].
UPWARD = 0.7


def as_shell(surface: OpenSurface, error_m: float, room: Room) -> Hull | None:
    """Return the hull of an open surface close below it, where nobody misses what that fills.

    Such are knobs, caps, panels without a back. ``None`` where dents of the surface itself are
    deeper than ``error_m`` [m], where a hand gets in, or another part is in it.
    """
    hull = hull_of(surface.vertices)
    if hull is None or concavity(surface.vertices, surface.faces, hull) > error_m:
        return None
    shallow = thickness(hull.vertices, hull.planes) <= HAND_M / 2.0 and not _opens_up(surface)
    if not shallow and not _keeps_hands_out(surface):
        return None
    return None if room.entered(hull) else hull


def closed(surface: OpenSurface, room: Room) -> Manifold | None:
    """Return the solid that a surface nearly encloses, where closing it keeps nobody out."""
    narrow = _keeps_hands_out(surface)
    # A bowl or a bottle that a hand gets into from above stays hollow.
    if not narrow and _opens_up(surface):
        return None
    solid = capped(surface)
    if solid is not None or not narrow:
        return solid
    solid = capped(surface, NARROW_SHARE)
    return None if solid is None or room.within(solid) else solid


def capped(surface: OpenSurface, share: float = OPENING_SHARE) -> Manifold | None:
    """Return the solid that a surface encloses once its small openings are closed, outward.

    ``None`` where the openings are more than a share of the surface's area, or closing them does
    not close it.
    """
    loops = _boundary_loops(surface.faces)
    if not loops:
        return None
    vertices = [surface.vertices]
    faces = [surface.faces]
    opening = 0.0
    for loop in loops:
        center = surface.vertices[loop].mean(axis=0)
        spokes = surface.vertices[loop] - center
        spread = np.cross(spokes, np.roll(spokes, -1, axis=0))
        opening += float(np.linalg.norm(spread, axis=1).sum()) / 2.0
        apex = len(surface.vertices) + len(vertices) - 1
        vertices.append(center[None])
        faces.append(np.column_stack([np.roll(loop, -1), loop, np.full(len(loop), apex)]))
    if opening > share * float(areas_of(surface.vertices[surface.faces]).sum()):
        return None
    points = np.concatenate(vertices)
    triangles = np.concatenate(faces)
    solid = manifold_of(points, triangles)
    inverted = solid is not None and solid.volume() < 0.0
    return manifold_of(points, triangles[:, ::-1]) if inverted else solid


def _keeps_hands_out(surface: OpenSurface) -> bool:
    """Tell whether no hand gets in through any opening of a surface."""
    loops = _boundary_loops(surface.faces)
    return bool(loops) and all(_width(surface.vertices[loop]) < HAND_M for loop in loops)


def _opens_up(surface: OpenSurface) -> bool:
    """Tell whether a surface is open towards the top, as a tray is, whichever way it is wound."""
    corners = surface.vertices[surface.faces]
    vectors = doubled_normals(corners) / 2.0
    middle = (surface.vertices.min(axis=0) + surface.vertices.max(axis=0)) / 2.0
    outward = float(np.einsum("ij,ij->", corners.mean(axis=1) - middle, vectors))
    opening = -vectors.sum(axis=0) * (1.0 if outward >= 0.0 else -1.0)
    return float(opening[2]) > UPWARD * float(np.linalg.norm(opening))


def _width(points: FloatArray) -> float:
    """Return how wide a loop is across its longest direction, in its own plane [m]."""
    centered = points - points.mean(axis=0)
    _, _, axes = np.linalg.svd(centered, full_matrices=False)
    extents = np.sort(np.ptp(centered @ axes.T, axis=0))
    return float(extents[-2])


def _boundary_loops(faces: IntArray) -> list[IntArray]:
    """Return the vertices around each opening, the way of the faces there; none if no loops."""
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
