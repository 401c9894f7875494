"""How deep two convex polyhedra penetrate each other, exactly.

The depth is the length of the shortest translation that separates them. Its direction is a face
normal of their Minkowski difference, which is a face normal of one of them or the cross product of
an edge of each whose arcs on the Gauss sphere cross (S. Gottschalk's separating axis theorem; D.
Gregorius, "The Separating Axis Test between Convex Polyhedra", GDC 2013). Hulls with thousands of
edges have too many pairs of them: there the Minkowski difference is grown from within, only where
the origin might be nearest, until nothing is left to grow (G. van den Bergen's expanding polytope,
2001, with a real convex hull in place of its fragile bookkeeping).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
from scipy.optimize import nnls
from scipy.spatial import ConvexHull, QhullError

from ..description import FloatArray
from .hull import CollisionHull

#: Edge pairs are tested in blocks of about this many, to bound memory.
BLOCK = 400_000
#: Sine of the angle below which two edges count as parallel.
PARALLEL = 1e-8
#: From this many edge pairs on, growing is faster.
MANY_EDGE_PAIRS = 100_000
#: Growing ends when a face of the inner polytope is this close to its support, as a share of the
#: hulls' size.
GROWN = 1e-12
MAX_GROWTH = 100
#: Corners this little beyond a face lie on it [m].
FLUSH = 1e-9
#: A gap is widest when no corner would narrow it by more than this [m].
WIDEST = 1e-9
MAX_WIDENING = 50
#: How many of the best edge pairs are verified at a time.
VERIFIED = 16


@dataclass(frozen=True)
class HullOverlap:
    """How two hulls stand.

    Attributes:
        depth: [m]; negative is a gap along ``direction``, at most the distance between the hulls.
        direction: unit vector along which the first hull pushes into the second, shape [3].
    """

    depth: float
    direction: FloatArray


def overlap_along(a: CollisionHull, b: CollisionHull, directions: FloatArray) -> FloatArray:
    """Return how far ``a`` reaches into ``b``, in the same frame [m]; negative separates.

    Reached are unit directions from ``a`` towards ``b``, shape [direction_count, 3].
    """
    near = (b.vertices @ directions.T).min(axis=0)
    reach: FloatArray = (a.vertices @ directions.T).max(axis=0) - near
    return reach


def _least(
    a: CollisionHull, b: CollisionHull, directions: FloatArray, found: HullOverlap | None = None
) -> HullOverlap:
    """Return the overlap along the best of some directions; what was found, if none is better."""
    reaches = overlap_along(a, b, directions)
    best = int(np.argmin(reaches))
    if found is not None and not reaches[best] < found.depth:
        return found
    return HullOverlap(float(reaches[best]), directions[best])


def overlap(a: CollisionHull, b: CollisionHull) -> HullOverlap:
    """Return the exact penetration depth of two hulls in one frame, or a separating direction."""
    if len(a.edges) * len(b.edges) > MANY_EDGE_PAIRS:
        grown = _grown(a, b)
        if grown is not None:
            return grown
    found = _faces(a, b)
    return found if found.depth < 0.0 else _edges(a, b, found)


def widest_gap(a: CollisionHull, b: CollisionHull, direction: FloatArray) -> HullOverlap:
    """Return the distance of two hulls that a direction separates, exactly, and its direction.

    The corners of the Minkowski difference nearest to the origin are collected one by one, and the
    point of their hull that is nearest is found anew (P. Wolfe's nearest point in a polytope,
    1976). Every direction tried separates by what the hulls' own corners say, so that no gap is
    overstated. The first is a unit vector from ``a`` towards ``b`` that separates them, shape [3].
    """
    found = _least(a, b, direction[None])
    points = _differences(a, b, direction[None])
    for _ in range(MAX_WIDENING):
        nearest = _nearest_to_origin(points)
        length = float(np.linalg.norm(nearest))
        if length + found.depth <= WIDEST:
            break
        direction = -nearest / length
        found = _least(a, b, direction[None], found)
        points = np.vstack([points, _differences(a, b, direction[None])])
    return found


def _nearest_to_origin(points: FloatArray) -> FloatArray:
    """Return the point of the points' convex hull that is nearest to the origin [m], shape [3]."""
    size = np.linalg.norm(points, axis=1).max()
    if not size > 0.0:
        return np.zeros(3)
    # With a row of ones the weights may have any sum: the best share is the same.
    scaled = points / size
    weights, _ = nnls(np.vstack([scaled.T, np.ones(len(points))]), np.array([0.0, 0.0, 0.0, 1.0]))
    nearest: FloatArray = weights @ points / weights.sum()
    return nearest


def _faces(a: CollisionHull, b: CollisionHull) -> HullOverlap:
    faces = np.vstack([a.normals, -b.normals])
    first = a.offsets - (b.vertices @ a.normals.T).min(axis=0)
    second = b.offsets - (a.vertices @ b.normals.T).min(axis=0)
    reaches = np.concatenate([first, second])
    best = int(np.argmin(reaches))
    return HullOverlap(float(reaches[best]), faces[best])


def _grown(a: CollisionHull, b: CollisionHull) -> HullOverlap | None:
    """Return the depth by growing the Minkowski difference; ``None`` if qhull gives up."""
    size = float(np.ptp(a.vertices, axis=0).max() + np.ptp(b.vertices, axis=0).max())
    grid = np.array([step for step in product((-1, 0, 1), repeat=3) if any(step)], dtype=float)
    grid /= np.linalg.norm(grid, axis=1)[:, None]
    found = _least(a, b, grid)
    if found.depth < 0.0:
        return found
    points = _differences(a, b, grid)
    for _ in range(MAX_GROWTH):
        try:
            equations = ConvexHull(points).equations
        except QhullError:
            return None
        # A face of the inner polytope beyond the best depth cannot hide a shallower way out.
        open_faces = equations[-equations[:, 3] < found.depth - GROWN * size, :3]
        if len(open_faces) == 0:
            return found
        found = _least(a, b, open_faces, found)
        if found.depth < 0.0:
            return found
        points = np.unique(np.vstack([points, _differences(a, b, open_faces)]), axis=0)
    return None


def _differences(a: CollisionHull, b: CollisionHull, directions: FloatArray) -> FloatArray:
    """Return extreme corners of the Minkowski difference by direction [m], [direction_count, 3]."""
    far = a.vertices[np.argmax(a.vertices @ directions.T, axis=0)]
    near = b.vertices[np.argmin(b.vertices @ directions.T, axis=0)]
    corners: FloatArray = far - near
    return corners


def _edges(a: CollisionHull, b: CollisionHull, found: HullOverlap) -> HullOverlap:
    """Improve on the best face by pairs of edges."""
    if len(a.edges) == 0 or len(b.edges) == 0:
        return found
    rows = max(1, BLOCK // len(b.edges))
    for start in range(0, len(a.edges), rows):
        found = _edge_block(a, b, slice(start, start + rows), found)
    return found


def _edge_block(a: CollisionHull, b: CollisionHull, rows: slice, found: HullOverlap) -> HullOverlap:
    first = a.edges[rows]
    second = b.edges
    here, there = np.nonzero(_arcs_cross(a.sides[rows], -b.sides))
    if len(here) == 0:
        return found
    along_a = a.vertices[first[here, 1]] - a.vertices[first[here, 0]]
    along_b = b.vertices[second[there, 1]] - b.vertices[second[there, 0]]
    axes = np.cross(along_a, along_b)
    length = np.linalg.norm(axes, axis=1)
    solid = length > PARALLEL * np.linalg.norm(along_a, axis=1) * np.linalg.norm(along_b, axis=1)
    here = here[solid]
    there = there[solid]
    axes = axes[solid] / length[solid, None]
    outward = np.einsum("ij,ij->i", axes, a.sides[rows][here].sum(axis=1))
    axes[outward < 0.0] *= -1.0
    reach = np.einsum("ij,ij->i", axes, a.vertices[first[here, 0]] - b.vertices[second[there, 0]])
    return _verified(a, b, axes, reach, found)


def _arcs_cross(first: FloatArray, second: FloatArray) -> np.ndarray:
    """Return which arcs between face normals cross; shapes [n, 2, 3] and [m, 2, 3] -> [n, m]."""
    a, b = first.transpose(1, 0, 2)
    c, d = second.transpose(1, 0, 2)
    across_first = np.cross(b, a)
    across_second = np.cross(d, c)
    c_side = across_first @ c.T
    d_side = across_first @ d.T
    a_side = a @ across_second.T
    b_side = b @ across_second.T
    cross: np.ndarray = (c_side * d_side < 0.0) & (a_side * b_side < 0.0) & (c_side * b_side > 0.0)
    return cross


def _verified(
    a: CollisionHull, b: CollisionHull, axes: FloatArray, reach: FloatArray, found: HullOverlap
) -> HullOverlap:
    """Return the best axis by full support: rounding may let in a pair that spans no face."""
    order = np.argsort(reach, kind="stable")
    for start in range(0, len(order), VERIFIED):
        some = order[start : start + VERIFIED]
        if reach[some[0]] >= found.depth:
            break
        found = _least(a, b, axes[some], found)
    return found


def contact_region(a: CollisionHull, b: CollisionHull) -> FloatArray:
    """Return corners of the intersection of two hulls [m], shape [corner_count, 3]; may be none.

    Every corner of the intersection lies on an edge of one hull clipped by the faces of the other.
    """
    return np.vstack([_clipped_edges(a, b), _clipped_edges(b, a)])


def _clipped_edges(a: CollisionHull, b: CollisionHull) -> FloatArray:
    # Boards cut flush share planes: rounding must not clip their edges away.
    beyond = a.vertices @ b.normals.T - b.offsets - FLUSH
    # Only faces that cut something off matter, and edges that lie wholly beyond one of them are
    # gone.
    beyond = beyond[:, beyond.max(axis=0) > 0.0]
    edges = a.edges[~((beyond[a.edges[:, 0]] > 0.0) & (beyond[a.edges[:, 1]] > 0.0)).any(axis=1)]
    start = a.vertices[edges[:, 0]]
    along = a.vertices[edges[:, 1]] - a.vertices[edges[:, 0]]
    before = beyond[edges[:, 0]]
    after = beyond[edges[:, 1]]
    with np.errstate(divide="ignore", invalid="ignore"):
        crossing = before / (before - after)
    enter = np.where(before > 0.0, crossing, 0.0).max(axis=1, initial=0.0)
    leave = np.where(after > 0.0, crossing, 1.0).min(axis=1, initial=1.0)
    kept = enter <= leave
    return np.vstack([start[kept] + at[kept, None] * along[kept] for at in (enter, leave)])
