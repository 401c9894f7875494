"""Convex hulls that meet, cut by planes until there is a gap between them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...asset import Hull
from ...geometry.triangles import doubled_normals
from ...mesh import FloatArray, IntArray
from ...runtime.numbers import DECIMALS
from ..decompose.convex import edges_of, hull_of
from ..poses import moved

#: A hull no thicker than this is a sheet, and what has no thickness is made so thick [m].
SHEET_M = 0.003
#: Of which at least this much is to be left by a cut [m].
LEFT_M = 0.001
#: Of what is needed between two hulls, shares that may go off the first.
SHARES = (0.0, 0.5, 1.0)
#: Directions with a smaller cosine are unlike one another; so many of those are tried, too.
ALIKE = 0.7
UNLIKE = 3
#: Volumes that differ by less than this share do so by rounding.
ROUNDING_SHARE = 1e-9
#: Corners this near to a plane lie on it [m].
FLUSH_M = 1e-7
#: Lengths that are the same to so many decimals differ by rounding [m].
ROUNDING_DECIMALS = 12

#: Most pieces that are kept of one hull.
MOST_PIECES = 4
#: Of the room's planes those that leave most of the hull outside, by its farthest corner.
PLANES_TRIED = 8
#: Pieces of less than this share of the hull or the room, or thinner than this [m], are splinters.
SPLINTER_SHARE = 0.001
SPLINTER_M = 0.002


@dataclass(frozen=True)
class HullMeeting:
    """How two hulls stand along the face normals that separate them best, best first.

    Attributes:
        directions: unit vectors from the first hull towards the second, the first hull's frame,
            shape [n, 3].
        first_ends, second_starts: their positions along each [m], shape [n].
        lags: how far before its pose the second was along each just before [m], shape [n]; at
            most 0.
    """

    directions: FloatArray
    first_ends: FloatArray
    second_starts: FloatArray
    lags: FloatArray

    @property
    def depth(self) -> float:
        """Return an upper bound of the penetration depth [m]: face normals only, no edge pairs."""
        return float(self.first_ends[0] - self.second_starts[0])


def depth_at(a: Hull, b: Hull, pose: FloatArray) -> float:
    """Return an upper bound of how deep two hulls lie in one another [m], the second moved."""
    _, ends, starts = _along_normals(a, b, pose)
    return float((ends - starts).min())


def _along_normals(a: Hull, b: Hull, pose: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the face normals of two hulls, where the first ends along each, the second begins."""
    directions = np.vstack([a.planes[:, :3], -b.planes[:, :3] @ pose[:3, :3].T])
    ends = (a.vertices @ directions.T).max(axis=0)
    return directions, ends, (moved(b.vertices, pose) @ directions.T).min(axis=0)


def meeting(a: Hull, b: Hull, pose: FloatArray, behind: FloatArray | None = None) -> HullMeeting:
    """Find six face normals that separate two hulls best; if they overlap, some unlike those too.

    Args:
        a: the first.
        b: the second.
        pose: by which the second is moved, [4, 4].
        behind: from there to where it slid here from, in the first hull's frame [m], shape [3];
            all of that way counts.
    """
    directions, ends, starts = _along_normals(a, b, pose)
    lags = np.zeros(len(directions)) if behind is None else np.minimum(directions @ behind, 0.0)
    starts = starts + lags
    # Triangles of one face reach equally far but for last digits, which must not choose among them.
    order = np.argsort(np.round(ends - starts, ROUNDING_DECIMALS), kind="stable")
    best = order[:6]
    if ends[best[0]] > starts[best[0]]:
        best = _with_others(directions, order, best)
    return HullMeeting(directions[best], ends[best], starts[best], lags[best])


def _with_others(directions: FloatArray, order: IntArray, best: IntArray) -> IntArray:
    """Return the best of some directions and the next best that are unlike all before them.

    A flat button has many faces that look up; a cut across it is found among the others.
    """
    for _ in range(UNLIKE):
        alike = directions[order] @ directions[best].T >= ALIKE
        others = order[~np.asarray(alike.any(axis=1))]
        best = np.append(best, others[:1])
    return best


def cut_apart(
    a: Hull, b: Hull, pose: FloatArray, met: HullMeeting, clearance_m: float
) -> tuple[Hull | None, Hull | None]:
    """Cut two hulls so that the least goes and ``clearance_m`` is left between.

    Hulls that barely meet give as they are thick: a sheet gives next to nothing. Where one lies
    deep in the other, every direction is tried with the cut all in the first, all in the second and
    half in each: a stem loses its end in the socket rather than the socket its rim.

    Returns:
        The hulls; ``None`` for one of which nothing is left.
    """
    deep = met.depth > clearance_m
    count = len(met.directions) if deep else 1
    shares = np.array(SHARES) if deep else np.array([_thicker_gives(a, b, pose, met.directions[0])])
    needed = (met.first_ends - met.second_starts)[:count, None] + clearance_m
    ends = (met.first_ends[:count, None] - shares * needed).ravel()
    shifts = met.directions[:count] @ pose[:3, 3] + met.lags[:count]
    starts = (met.second_starts[:count, None] + (1.0 - shares) * needed - shifts[:, None]).ravel()
    normals = np.repeat(met.directions[:count], len(shares), axis=0)
    backs = normals @ pose[:3, :3]
    best = 0
    if deep:
        left = volumes_below(a, normals, ends) + volumes_below(b, -backs, -starts)
        # Of cuts that differ by rounding only the first.
        best = int((left >= left.max() - ROUNDING_SHARE * (a.volume + b.volume)).argmax())
    cut = clipped if deep else given_way
    return (cut(a, normals[best], float(ends[best])), cut(b, -backs[best], -float(starts[best])))


def _thicker_gives(a: Hull, b: Hull, pose: FloatArray, direction: FloatArray) -> float:
    """Return the first hull's share of a cut across a direction."""
    first = float(np.ptp(a.vertices @ direction))
    second = float(np.ptp(b.vertices @ (direction @ pose[:3, :3])))
    return first / (first + second)


def given_way(hull: Hull, normal: FloatArray, offset: float) -> Hull | None:
    """Clip a hull, but move a sheet of which hardly any would be left.

    It stands for a surface whose other side nobody knows; shaved away it would leave a hole.
    """
    along = hull.vertices @ normal
    over = float(along.max()) - offset
    if over <= 0.0 or float(np.ptp(along)) > SHEET_M or float(along.min()) < offset - LEFT_M:
        return clipped(hull, normal, offset)
    return Hull(np.round(hull.vertices - over * normal, DECIMALS) + 0.0, hull.faces)


def volumes_below(hull: Hull, normals: FloatArray, offsets: FloatArray) -> FloatArray:
    """Return the volume of a hull that :func:`clipped` leaves at each plane [m3], shape [n].

    By the divergence theorem, seen from a point of the plane, from where the cut face takes no
    room: a triangle counts by the share of it that lies below. The kept side has ``normal . x <=
    offset`` [m]; normals are unit vectors, shape [n, 3].
    """
    center = hull.vertices.mean(axis=0)
    points = hull.vertices - center
    levels = offsets - normals @ center
    corners = points[hull.faces]
    areas = doubled_normals(corners)
    heights = (points @ normals.T - levels)[hull.faces]
    heights.sort(axis=1)
    low, middle, high = heights.transpose(1, 0, 2)
    with np.errstate(divide="ignore", invalid="ignore"):
        top = high**2 / ((high - low) * (high - middle))
        bottom = low**2 / ((low - high) * (low - middle))
    below = np.select([high <= 0.0, middle <= 0.0, low < 0.0], [1.0, 1.0 - top, bottom], 0.0)
    cones = np.einsum("ij,ij->i", corners[:, 0], areas)[:, None] - areas @ normals.T * levels
    return np.asarray((below * cones).sum(axis=0) / 6.0)


def clipped(hull: Hull, normal: FloatArray, offset: float) -> Hull | None:
    """Return what of a hull has ``normal . x <= offset`` [m]; ``None`` if no volume is left."""
    height = hull.vertices @ normal - offset
    # Where an edge that all but lies in the plane crosses it, last digits would say.
    height[np.abs(height) < FLUSH_M] = 0.0
    if height.max() <= 0.0:
        return hull
    edges = edges_of(hull)
    edges = edges[np.diff(height[edges] < 0.0, axis=1)[:, 0]]
    start, end = height[edges].T
    share = (start / (start - end))[:, None]
    first, second = np.moveaxis(hull.vertices[edges], 1, 0)
    return hull_of(np.concatenate([hull.vertices[height <= 0.0], first + share * (second - first)]))


def carved(
    solid: Hull, room: FloatArray, clearance_m: float, most: int = MOST_PIECES
) -> list[Hull]:
    """Return the rest of a hull outside some room, as at most so many convex pieces.

    Piece by piece the largest that one plane of the room leaves outside is kept. The room is the
    convex hull of points [m], shape [n, 3], with the clearance around it.
    """
    around = hull_of(room)
    if around is None:
        return []
    planes = around.planes.copy()
    planes[:, 3] += clearance_m
    least = SPLINTER_SHARE * min(solid.volume, around.volume)
    kept: list[Hull] = []
    rest: Hull | None = solid
    while rest is not None and len(kept) < most:
        heights = (rest.vertices @ planes[:, :3].T).max(axis=0) - planes[:, 3]
        tried = np.argsort(-heights, kind="stable")[:PLANES_TRIED]
        tried = tried[heights[tried] > SPLINTER_M]
        outside = volumes_below(rest, -planes[tried, :3], -planes[tried, 3])
        if not (outside >= least).any():
            break
        plane = int(tried[outside.argmax()])
        piece = clipped(rest, -planes[plane, :3], -float(planes[plane, 3]))
        if piece is None:
            break
        kept.append(piece)
        rest = clipped(rest, planes[plane, :3], float(planes[plane, 3]))
    return kept
