"""One part: convex stays whole, boards are cut, the rest is searched, open surfaces get slabs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from manifold3d import Manifold

from ...asset import Hull
from ...config import DecomposeConfig
from ...mesh import FloatArray, IntArray
from .convex import SAME_M, concavity, depth_below, hull_of, limit_vertices, surface_points
from .cut import opened
from .merge import TOGETHER, merge
from .methods import split_closely
from .openings import as_shell, closed
from .outside import uncovered
from .pieces import NOTHING, SolidPieces
from .pockets import slot_of
from .room import Room
from .sheets import slabs
from .simplify import lighter
from .solids import Gated, OpenSurface, contains, gate, union

#: How far a simplified open surface may leave the original bare, as a share of the error.
COVER_SHARE = 0.6
#: A slab over an open surface adds nothing to a hull that it stands out of by this share of the
#: error.
PROUD_SHARE = 0.2


def split_part(
    vertices: FloatArray,
    faces: IntArray,
    error_m: float,
    config: DecomposeConfig,
    room: Room,
    hollow: bool,
) -> SolidPieces | None:
    """Return the convex hulls of the triangles of one part; ``None`` if nothing in it is a body.

    Vertices are welded [m], shape [n, 3]. No dent that a hull fills is deeper than ``error_m`` [m];
    the configuration's error is the least, where others are near. Open surfaces of a ``hollow``
    part are walls: what they surround is never closed or filled.
    """
    gated = gate(vertices, faces)
    single = None if hollow else _single(vertices, faces, gated, error_m, config)
    if single is not None and not room.entered(single):
        return SolidPieces((single,), "single")
    found = NOTHING
    walls: list[Hull] = []
    solids = _outermost(gated.solids)
    for cavity in gated.cavities:
        solids = [piece for solid in solids for piece in opened(solid, cavity)]
    for sheet in gated.sheets:
        shell = None if hollow else as_shell(sheet, config.error_m, room)
        solid = None if hollow or shell is not None else closed(sheet, room)
        if shell is not None:
            found += SolidPieces((shell,), "single")
        elif solid is not None:
            solids += solid.decompose()
        else:
            walls += _cover(sheet, vertices.mean(axis=0), config)
    for solid in solids:
        found += split_closely(solid, error_m, config, room)
    if walls:
        proud = _not_inside_others([*found.hulls, *walls], PROUD_SHARE * config.error_m)
        solid_ones = {id(hull) for hull in found.hulls}
        walls = [hull for hull in proud if id(hull) not in solid_ones]
        found += SolidPieces(tuple(walls), "sheets")
    return _finished(found, error_m, config, room) if found.hulls else None


def _finished(
    found: SolidPieces, error_m: float, config: DecomposeConfig, room: Room
) -> SolidPieces:
    """Return pieces of one part joined where that fills little, none in another, none too fine."""
    hulls = list(found.hulls)
    if found.method != "exact" or len(hulls) > TOGETHER:
        hulls = merge(hulls, error_m, slot_of(config), room)
    limited = [limit_vertices(each, config.max_vertices) for each in _not_inside_others(hulls)]
    return replace(found, hulls=tuple(limited))


def _single(
    vertices: FloatArray, faces: IntArray, gated: Gated, error_m: float, config: DecomposeConfig
) -> Hull | None:
    """Return the whole part as one hull, where all of it lies close below that hull's surface."""
    if len(gated.solids) + len(gated.sheets) < 2 or not gated.solids or gated.cavities:
        return None
    hull = hull_of(vertices[np.unique(faces)])
    if hull is None or concavity(vertices, faces, hull) > error_m:
        return None
    if union(list(gated.solids)).volume() < config.near_convex * hull.volume:
        return None
    return limit_vertices(hull, config.max_vertices)


def _outermost(solids: Sequence[Manifold]) -> list[Manifold]:
    """Return the bodies that lie inside no other body; of duplicates one."""
    volumes = [solid.volume() for solid in solids]
    outer = _outer(volumes, lambda other, one: contains(solids[other], solids[one]))
    return [solids[number] for number in outer]


def _outer(volumes: Sequence[float], holds: Callable[[int, int], bool]) -> list[int]:
    """Return the numbers of those that no larger one holds, in order."""
    kept: list[int] = []
    for number in sorted(range(len(volumes)), key=lambda number: -volumes[number]):
        if not any(holds(other, number) for other in kept):
            kept.append(number)
    return sorted(kept)


def _cover(sheet: OpenSurface, center: FloatArray, config: DecomposeConfig) -> list[Hull]:
    """Return the slabs over an open surface, simplified as far as that keeps it covered."""
    error_m = config.error_m
    points = surface_points(sheet.vertices, sheet.faces)
    for max_faces in (config.max_faces // 4, config.max_faces, len(sheet.faces)):
        light = lighter(sheet, max_faces)
        hulls = merge(slabs(light, error_m, config.shell_m, center), error_m)
        if light is sheet or uncovered(hulls, points) <= COVER_SHARE * error_m:
            break
    return hulls


def _not_inside_others(hulls: list[Hull], proud_m: float = SAME_M) -> list[Hull]:
    """Return the hulls that stand out of every larger one by more than ``proud_m`` [m]."""

    def holds(other: int, one: int) -> bool:
        # Most boxes tell, long before their hulls' planes would.
        low, high = hulls[other].bounds
        if (low - proud_m > hulls[one].bounds[0]).any():
            return False
        if (high + proud_m < hulls[one].bounds[1]).any():
            return False
        return float(depth_below(hulls[other], hulls[one].vertices).min()) >= -proud_m

    return [hulls[number] for number in _outer([hull.volume for hull in hulls], holds)]
