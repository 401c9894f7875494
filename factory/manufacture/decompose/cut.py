"""Convex pieces of a solid by planes: along its own faces, exact; or across its box, coarse."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
from manifold3d import Manifold

from ...asset import Hull
from ...config import DecomposeConfig
from ...geometry.edges import shared_edges
from ...geometry.rows import distinct_rows
from ...geometry.triangles import doubled_normals
from ...mesh import FloatArray, IntArray
from .convex import THINNEST_M, concavity, hull_of
from .pieces import NOTHING, SolidPieces
from .pockets import fills_little, slot_of
from .solids import LEAST_VOLUME_M3, triangles_of

#: Share of its hull that a convex body fills, rounding of the input's vertices allowed for.
CONVEX_SHARE = 0.999
#: Edges that bend inwards by less than this are noise on a flat face [rad].
REFLEX_ANGLE = np.radians(3.0)
#: Steps smaller than this share of a piece's size are rounding.
LAYER_SHARE = 2e-6
#: Cutting planes tried per piece; the ones with the longest inward edges come first.
PLANES_TRIED = 24
#: Solids with more inward edges are curved: not made of boards, not worth cutting along planes.
REFLEX_EDGES = 400
#: Exact pieces that are kept as they are; more are joined where that fills little.
FEW_PIECES = 32
#: Where planes across a piece are tried, as shares of its extents.
PLACES = (0.25, 0.5, 0.75)


def as_one(solid: Manifold, error_m: float, config: DecomposeConfig) -> SolidPieces | None:
    """Return a solid as one hull if that fills little, see ``fills_little``; else ``None``."""
    vertices, faces = triangles_of(solid)
    hull = hull_of(vertices)
    if hull is None:
        return None
    dent = concavity(vertices, faces, hull)
    # As far off a plane rounding may leave a vertex.
    flat_m = THINNEST_M + 1e-5 * float(np.ptp(vertices, axis=0).max())
    if dent <= flat_m and solid.volume() >= CONVEX_SHARE * hull.volume:
        return SolidPieces((hull,), "exact")
    little = fills_little(hull, solid, error_m, slot_of(config))
    return SolidPieces((hull,), "single") if little else None


def cut_along_faces(
    solid: Manifold, error_m: float, config: DecomposeConfig, most: int = FEW_PIECES
) -> SolidPieces | None:
    """Return the convex pieces of a solid made of flat faces; ``None`` of one that is curved.

    Each piece is cut along that plane of one of its inward edges which leaves the least volume
    between the pieces and their hulls, until no dent is deeper than ``error_m`` [m] (notch cutting:
    Chazelle 1984, greedily). ``None`` too where more than ``most`` pieces are needed.
    """
    waiting = list(solid.decompose())
    found = NOTHING
    while waiting:
        piece = waiting.pop()
        if piece.volume() <= LEAST_VOLUME_M3 or hull_of(triangles_of(piece)[0]) is None:
            continue
        whole = as_one(piece, error_m, config)
        if whole is not None:
            found += whole
            continue
        halves = _best_cut(piece)
        if halves is None or len(found.hulls) + len(waiting) + len(halves) > most:
            return None
        waiting += halves
    several = found.method != "exact" and len(found.hulls) > 1
    return replace(found, method="cut") if several else found


def opened(solid: Manifold, cavity: Manifold) -> list[Manifold]:
    """Return a solid without a cavity, in pieces that are each one connected surface.

    An enclosed cavity has a surface of its own, which no step after this one would tell from a
    second body: the solid is cut through the cavity's middle, along one of its faces.
    """
    hollow = solid - cavity
    pieces = list(hollow.decompose())
    if all(piece.volume() > 0.0 for piece in pieces):
        return pieces
    vertices, faces = triangles_of(cavity)
    normals = doubled_normals(vertices[faces])
    area = np.linalg.norm(normals, axis=1)
    normal = normals[area.argmax()] / area.max()
    return _halves_of(hollow, normal, float(vertices.mean(axis=0) @ normal))


def halve(solid: Manifold, outside_m: float, most: int) -> list[Hull]:
    """Return hulls that together cover a solid, cut in two where a hull stands out of it most.

    Each piece is cut by the plane across one of its box's axes that saves the most volume, until
    the hulls lie ``outside_m`` outside on average over the solid's surface [m], or are ``most``.
    """
    pieces = [(_waste_of([piece]), piece) for piece in solid.decompose()]
    enough = outside_m * solid.surface_area()
    while 0 < len(pieces) < most and sum(waste for waste, _ in pieces) > enough:
        worst = max(range(len(pieces)), key=lambda index: pieces[index][0])
        best = min(_cuts_across(pieces.pop(worst)[1]), key=_waste_of)
        pieces += [(_waste_of([piece]), piece) for piece in best]
    hulls = (hull_of(triangles_of(piece)[0]) for _, piece in pieces)
    return [hull for hull in hulls if hull is not None]


def _cuts_across(solid: Manifold) -> Iterator[list[Manifold]]:
    """Yield the pieces that each of the planes across a solid's box makes of it."""
    low, high = np.array(solid.bounding_box()).reshape(2, 3)
    for axis, normal in enumerate(np.eye(3)):
        for share in PLACES:
            yield _halves_of(solid, normal, float(low[axis] + share * (high[axis] - low[axis])))


def _best_cut(piece: Manifold) -> list[Manifold] | None:
    """Return what the plane that wastes least leaves of a piece; ``None`` if none divides it."""
    # The first cut through a ring leaves as much waste as before, so the least waste wins, not less
    # waste.
    cuts = (
        [half for half in _halves_of(piece, *plane) if half.volume() > LEAST_VOLUME_M3]
        for plane in _candidate_planes(*triangles_of(piece))
    )
    return min((cut for cut in cuts if len(cut) > 1), key=_waste_of, default=None)


def _halves_of(piece: Manifold, normal: FloatArray, offset: float) -> list[Manifold]:
    """Return a solid's two sides of a plane, in connected pieces.

    A plane along a face would leave films of rounding's thickness on the wrong side, so a layer
    about it is taken away, and what ends there is then stretched back to the plane.
    """
    corners = np.array(piece.bounding_box()).reshape(2, 3)
    layer = LAYER_SHARE * float(np.ptp(corners, axis=0).max())
    pieces: list[Manifold] = []
    for direction, start in ((normal, offset + layer), (-normal, layer - offset)):
        side = piece.trim_by_plane(tuple(direction), float(start))
        if side.num_tri():
            pieces += side.warp_batch(_stretch(direction, start, layer)).decompose()
    return pieces


def _stretch(
    direction: FloatArray, start: float, layer: float
) -> Callable[[FloatArray], FloatArray]:
    """Return the vectors that move points at the end of a layer back to its plane."""

    def stretched(points: FloatArray) -> FloatArray:
        ends = points @ direction - start < 0.1 * layer
        return np.asarray(points - layer * np.outer(ends, direction))

    return stretched


def _waste_of(pieces: list[Manifold]) -> float:
    """Return the volume between pieces and their hulls [m3]."""
    return float(sum(piece.hull().volume() - piece.volume() for piece in pieces))


def _candidate_planes(vertices: FloatArray, faces: IntArray) -> list[tuple[FloatArray, float]]:
    """Return the planes through inward edges, those with the longest and sharpest edges first."""
    corners = vertices[faces]
    normals = doubled_normals(corners)
    area = np.linalg.norm(normals, axis=1)
    normals = normals / np.maximum(area, 1e-300)[:, None]
    shared = shared_edges(faces)
    start, end = shared.vertices.T
    # The face that walks an edge from its lower vertex on is the left one.
    one, other = shared.faces.T
    forward = shared.forward[:, 0]
    left = np.where(forward, one, other)
    right = np.where(forward, other, one)
    along = vertices[end] - vertices[start]
    bend = np.einsum("ij,ij->i", np.cross(normals[left], normals[right]), along)
    length = np.linalg.norm(along, axis=1)
    angle = np.arctan2(
        bend / np.maximum(length, 1e-300), np.einsum("ij,ij->i", normals[left], normals[right])
    )
    reflex = angle < -REFLEX_ANGLE
    if not reflex.any() or reflex.sum() > REFLEX_EDGES:
        return []
    weight = np.tile((length * -angle)[reflex], 2)
    owner = np.concatenate([left[reflex], right[reflex]])
    offset = np.einsum("ij,ij->i", normals[owner], corners[owner, 0])
    return _heaviest(normals[owner], offset, weight, float(np.ptp(vertices, axis=0).max()))


def _heaviest(
    normals: FloatArray, offsets: FloatArray, weight: FloatArray, size: float
) -> list[tuple[FloatArray, float]]:
    """Return the planes of the most weight, by normal and offset."""
    # One plane per direction and place, whichever side its faces look to.
    sign = np.sign(np.take_along_axis(normals, np.abs(normals).argmax(axis=1)[:, None], axis=1))
    key = np.round(
        np.column_stack([normals * sign, offsets[:, None] * sign / max(size, 1e-12)]) * 1e4
    ).astype(np.int64)
    index, label = distinct_rows(key)
    total = np.bincount(label, weights=weight)
    order = np.argsort(-total, kind="stable")[:PLANES_TRIED]
    return [(normals[index[i]], float(offsets[index[i]])) for i in order]
