"""What a hull would fill: the pockets between it and what it stands for."""

from __future__ import annotations

import numpy as np
from manifold3d import Manifold
from scipy.spatial import HalfspaceIntersection, QhullError

from ...asset import Hull
from ...config import DecomposeConfig
from ...geometry.triangles import doubled_normals
from .convex import depth_below, hull_of
from .solids import LEAST_VOLUME_M3, manifold_of_hull, triangles_of

#: Pockets below this share of a cube of the error's side are dust.
DUST_SHARE = 0.05
#: Shallower than this share of the error is no pocket; nor does it join two others into one.
SKIN_SHARE = 0.1
#: A pocket is a slot, not a dent, when its thin direction makes at most this cosine with its
#: mouth's normal.
SLOT_COSINE = 0.3


def slot_of(config: DecomposeConfig) -> float:
    """Return the width of slots that a hull may fill [m], however far it may be off elsewhere."""
    return 2.0 * config.error_m


def fills_little(hull: Hull, solid: Manifold, error_m: float, slot_m: float) -> bool:
    """Return whether ``hull`` may stand for ``solid``: its surface is within ``error_m`` of it.

    That is so where every pocket it fills is a dent no deeper than ``error_m``, or a slot or hole
    no wider than ``slot_m`` [m], whatever its depth: nobody's clearance shrinks by more than
    ``error_m``. The solid may be several that overlap, as one.
    """
    core = shrunk(hull, SKIN_SHARE * error_m)
    if core is None:
        # Thinner than its own skin: a grain, or foil.
        core = manifold_of_hull(hull)
    dust = max(LEAST_VOLUME_M3, DUST_SHARE * error_m**3)
    large = [pocket for pocket in (core - solid).decompose() if pocket.volume() > dust]
    large.sort(key=lambda pocket: -pocket.volume())
    return all(_narrow(pocket, hull, error_m, slot_m) for pocket in large)


def shrunk(hull: Hull, depth_m: float) -> Manifold | None:
    """Return what of a hull is deeper than ``depth_m`` below its surface; ``None`` if nothing."""
    planes = hull.planes
    # Offset from the vertices' mean: by far the most hulls are deep enough there.
    center = hull.vertices.mean(axis=0)
    offsets = planes[:, 3] - planes[:, :3] @ center - depth_m
    if offsets.min() <= 0.0:
        return None
    try:
        inner = HalfspaceIntersection(np.column_stack([planes[:, :3], -offsets]), np.zeros(3))
    except (QhullError, ValueError):
        return None
    return Manifold.hull_points(inner.intersections + center)


def _narrow(pocket: Manifold, hull: Hull, error_m: float, slot_m: float) -> bool:
    """Tell whether a pocket below a hull's surface is a shallow dent or a narrow slot."""
    vertices, faces = triangles_of(pocket)
    around = hull_of(vertices)
    if around is None:
        return True
    planes = around.planes
    widths = np.ptp(around.vertices @ planes[:, :3].T, axis=0)
    width = float(widths.min())
    if width <= min(error_m, slot_m):
        return True
    if width > max(error_m, slot_m):
        return False
    across = planes[int(widths.argmin()), :3]
    corners = vertices[faces]
    areas = doubled_normals(corners)
    mouth = depth_below(hull, corners.mean(axis=1)) < 1.01 * SKIN_SHARE * error_m
    area = float(np.linalg.norm(areas[mouth], axis=1).sum())
    faces_it = float(np.abs(areas[mouth] @ across).sum())
    if width <= slot_m:
        return area > 0.0 and faces_it <= SLOT_COSINE * area
    # A dent's mouth looks along its thin direction; a gap as wide, behind a handle, does not.
    return faces_it > (1.0 - SLOT_COSINE) * area
