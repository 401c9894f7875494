"""Open surfaces as thin convex slabs: walls get a thickness, cavities stay open, none grow out."""

from __future__ import annotations

import heapq
import math
from dataclasses import dataclass, field

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from ...asset import Hull
from ...geometry.edges import shared_edges
from ...geometry.triangles import doubled_normals
from ...mesh import FloatArray
from ...runtime.numbers import rounded
from .convex import hull_of
from .solids import OpenSurface

#: Share of its outline's convex hull that a flat patch may leave empty, for rounding's sake.
SPARE_SHARE = 0.002


@dataclass
class _Patch:
    """Faces that may become one slab.

    Attributes:
        points: corners [m], shape [n, 3]; only those that can still be corners of a hull.
        normal: sum of the faces' area vectors [m2], shape [3].
        near: ids of adjacent patches.
    """

    points: FloatArray
    normal: FloatArray
    near: set[int] = field(default_factory=set)


def slabs(
    surface: OpenSurface, error_m: float, thickness_m: float, center: FloatArray
) -> list[Hull]:
    """Return the convex slabs over an open surface, consistently wound: one per patch.

    Neighbouring faces are joined, cheapest first, as long as what they span stays within
    ``error_m`` [m] of them: no higher than that over their mean plane, and no wider than that
    beyond their outline. Slabs are ``thickness_m`` thick, towards the inside [m], on which
    ``center`` [m], shape [3], lies where the surface does not show it. Patches too small to be
    anything are left out.
    """
    corners = surface.vertices[surface.faces]
    vectors = doubled_normals(corners) / 2.0
    inward = -_outward_sign(corners, vectors, center)
    patches = _grow(surface, vectors, error_m)
    hulls = []
    for patch in patches:
        direction = inward * patch.normal / max(float(np.linalg.norm(patch.normal)), 1e-300)
        hull = hull_of(np.concatenate([patch.points, patch.points + thickness_m * direction]))
        if hull is not None:
            hulls.append(hull)
    return hulls


def _outward_sign(corners: FloatArray, vectors: FloatArray, center: FloatArray) -> float:
    """Return 1 if the faces look away from what they surround, -1 if towards it."""
    middles = corners.mean(axis=1)
    area = np.linalg.norm(vectors, axis=1)
    own = middles - np.average(middles, axis=0, weights=np.maximum(area, 1e-300))
    enclosed = float(np.einsum("ij,ij->", own, vectors))
    reach = float(np.linalg.norm(own, axis=1).max() * area.sum())
    if abs(enclosed) <= 1e-3 * reach:
        enclosed = float(np.einsum("ij,ij->", middles - center, vectors))
    return -1.0 if enclosed < 0.0 else 1.0


def _grow(surface: OpenSurface, vectors: FloatArray, error_m: float) -> list[_Patch]:
    patches = {
        i: _Patch(surface.vertices[face], vector)
        for i, (face, vector) in enumerate(zip(surface.faces, vectors, strict=True))
    }
    queue: list[tuple[float, int, int]] = []
    for a, b in np.unique(shared_edges(surface.faces).faces, axis=0).tolist():
        patches[a].near.add(b)
        patches[b].near.add(a)
        _offer(queue, patches, a, b, error_m)
    fresh = len(patches)
    while queue:
        _, a, b = heapq.heappop(queue)
        if a not in patches or b not in patches:
            continue
        first = patches.pop(a)
        second = patches.pop(b)
        points = np.unique(np.concatenate([first.points, second.points]), axis=0)
        near = (first.near | second.near) - {a, b}
        patches[fresh] = _Patch(points, first.normal + second.normal, near)
        for other in near:
            patches[other].near -= {a, b}
            patches[other].near.add(fresh)
            _offer(queue, patches, fresh, other, error_m)
        fresh += 1
    return list(patches.values())


def _offer(
    queue: list[tuple[float, int, int]], patches: dict[int, _Patch], a: int, b: int, error_m: float
) -> None:
    cost = _cost(patches[a], patches[b], error_m)
    if cost <= 1.0:
        heapq.heappush(queue, (cost, min(a, b), max(a, b)))


def _cost(first: _Patch, second: _Patch, error_m: float) -> float:
    """Return how much of the allowed error joining two patches would use; more than 1 is too much.

    Rounded, so that faces of one plane cost the same, whatever the last digits are: the first one
    met is joined first.
    """
    normal = first.normal + second.normal
    area = math.sqrt(float(normal @ normal))
    if area <= 0.0 or float(first.normal @ second.normal) < 0.0:
        return np.inf
    points = np.concatenate([first.points, second.points])
    direction = normal / area
    heights = points @ direction
    height = float(heights.max() - heights.min())
    if height > error_m:
        return np.inf
    outline, length = _outline(points, direction)
    allowed = SPARE_SHARE * outline + 0.25 * error_m * length
    return rounded(max(height / error_m, (outline - area) / allowed))


def _outline(points: FloatArray, direction: FloatArray) -> tuple[float, float]:
    """Return the area [m2] and length [m] of points' convex outline, seen along a direction."""
    flat = points @ _across(*direction.tolist())
    try:
        found = ConvexHull(flat - flat[0])
    except (QhullError, ValueError):
        return 0.0, float(np.ptp(flat, axis=0).max())
    return float(found.volume), float(found.area)


def _across(x: float, y: float, z: float) -> FloatArray:
    """Return two unit vectors across a unit vector, as columns, shape [3, 2] (Duff et al. 2017)."""
    sign = math.copysign(1.0, z)
    a = -1.0 / (sign + z)
    b = x * y * a
    return np.array([[1.0 + sign * x * x * a, b], [sign * b, sign + y * y * a], [-sign * x, -y]])
