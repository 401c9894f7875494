"""One part: convex stays whole, boards are cut, the rest is searched, open surfaces get slabs."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from manifold3d import Manifold

from ...asset import Hull
from ...config import DecomposeConfig
from ...mesh import FloatArray, IntArray
from .caps import capped
from .convex import concavity, depth_below, hull_of, limit_vertices, surface_points
from .cut import opened
from .merge import merge
from .methods import FAITHFUL, SolidPieces, slot_of, split_solid
from .outside import uncovered
from .refine import refined
from .room import NOWHERE, Room
from .sheets import slabs
from .shells import as_shell, narrow_openings, opens_up
from .simplify import lighter
from .solids import Gated, OpenSurface, contains, gate, union

#: A part of more hulls than this has them joined where that fills little, even exact ones.
MANY_HULLS = 24
#: Narrow openings of a surface are closed up to this share of its area.
NARROW_SHARE = 0.35
#: How far a simplified open surface may leave the original bare, as a share of the error.
COVER_SHARE = 0.6
#: A hull this little below another one's surface lies in it [m].
TOUCHING_M = 1e-6
#: A slab over an open surface adds nothing to a hull that it stands out of by this share of the
#: error.
PROUD_SHARE = 0.2


@dataclass(frozen=True)
class PartPieces:
    """Hulls of one part; fields as in ``PartHulls``."""

    hulls: tuple[Hull, ...]
    method: str
    degraded: tuple[str, ...]
    exact: bool


@dataclass
class _Heap:
    """Pieces gathered so far."""

    hulls: list[Hull] = field(default_factory=list)
    method: str = "exact"
    degraded: list[str] = field(default_factory=list)
    exact: bool = True

    def add(self, split: SolidPieces) -> None:
        """The pieces of one more solid, or of open surfaces."""
        self.hulls += split.hulls
        self.method = max(self.method, split.method, key=FAITHFUL.index)
        self.exact = self.exact and split.exact
        self.degraded += split.degraded


def split_part(
    vertices: FloatArray,
    faces: IntArray,
    error_m: float,
    config: DecomposeConfig,
    room: Room = NOWHERE,
    hollow: bool = False,
) -> PartPieces | None:
    """Return the convex hulls of the triangles of one part.

    Args:
        vertices: welded positions [m], shape [n, 3].
        faces: shape [m, 3].
        error_m: deepest dent that a hull may fill [m].
        config: everything else; its ``error_m`` is the least, where others are near.
        room: that other parts take.
        hollow: open surfaces are walls: what they surround is never closed or filled.

    Returns:
        ``None`` if nothing in it is a body.
    """
    gated = gate(vertices, faces)
    single = None if hollow else _single(vertices, faces, gated, error_m, config)
    if single is not None and not room.entered(single.hulls[0]):
        return single
    heap = _Heap()
    open_hulls: list[Hull] = []
    solids = _hollowed(_outermost(list(gated.solids)), list(gated.cavities))
    for sheet in gated.sheets:
        shell = None if hollow else as_shell(sheet, config.error_m, room)
        solid = None if hollow or shell is not None else _closed(sheet, room)
        if shell is not None:
            heap.add(SolidPieces((shell,), "single"))
        elif solid is not None:
            heap.exact = False
            solids += solid.decompose()
        else:
            open_hulls += _cover(sheet, vertices.mean(axis=0), config)
    for solid in solids:
        heap.add(refined(solid, split_solid(solid, error_m, config), error_m, config, room))
    if open_hulls:
        standing_out = _not_inside_others([*heap.hulls, *open_hulls], PROUD_SHARE * config.error_m)
        slabs_only = {id(hull) for hull in open_hulls}
        open_hulls = [hull for hull in standing_out if id(hull) in slabs_only]
        merged = merge(open_hulls, error_m, slot_of(config), room)
        heap.add(SolidPieces(tuple(merged), "sheets"))
    if not heap.hulls:
        return None
    if len(heap.hulls) > MANY_HULLS:
        merged = merge(heap.hulls, error_m, slot_of(config), room)
        heap.exact = heap.exact and len(merged) == len(heap.hulls)
        heap.hulls = merged
    hulls = tuple(
        limit_vertices(hull, config.max_vertices) for hull in _not_inside_others(heap.hulls)
    )
    exact = heap.exact and all(len(hull.vertices) <= config.max_vertices for hull in heap.hulls)
    return PartPieces(hulls, heap.method, tuple(heap.degraded), exact)


def _closed(sheet: OpenSurface, room: Room) -> Manifold | None:
    """Return the solid that a surface nearly encloses, where closing it keeps nobody out."""
    narrow = narrow_openings(sheet)
    # A bowl or a bottle that a hand gets into from above stays hollow.
    if not narrow and opens_up(sheet):
        return None
    solid = capped(sheet)
    if solid is not None or not narrow:
        return solid
    solid = capped(sheet, NARROW_SHARE)
    return None if solid is None or room.within(solid) else solid


def _single(
    vertices: FloatArray, faces: IntArray, gated: Gated, error_m: float, config: DecomposeConfig
) -> PartPieces | None:
    """Return the whole part as one hull, where all of it lies close below that hull's surface."""
    if len(gated.solids) + len(gated.sheets) < 2 or not gated.solids or gated.cavities:
        return None
    hull = hull_of(vertices[np.unique(faces)])
    if hull is None or concavity(vertices, faces, hull) > error_m:
        return None
    if sum(solid.volume() for solid in gated.solids) < config.near_convex * hull.volume:
        return None
    if union(list(gated.solids)).volume() < config.near_convex * hull.volume:
        return None
    return PartPieces((limit_vertices(hull, config.max_vertices),), "single", (), False)


def _outermost(solids: list[Manifold]) -> list[Manifold]:
    """Without bodies that lie inside one other body, duplicates included."""
    order = sorted(range(len(solids)), key=lambda i: -solids[i].volume())
    kept: list[int] = []
    for i in order:
        if not any(contains(solids[k], solids[i]) for k in kept):
            kept.append(i)
    return [solids[i] for i in sorted(kept)]


def _hollowed(solids: list[Manifold], cavities: list[Manifold]) -> list[Manifold]:
    """Return the solids with what is hollow in them cut out."""
    for cavity in cavities:
        solids = [piece for solid in solids for piece in opened(solid, cavity)]
    return solids


def _cover(sheet: OpenSurface, center: FloatArray, config: DecomposeConfig) -> list[Hull]:
    """Return the slabs over an open surface, simplified as far as that keeps it covered."""
    error_m = config.error_m
    points = surface_points(sheet.vertices, sheet.faces)
    for max_faces in (config.max_faces // 4, config.max_faces):
        light = lighter(sheet, max_faces)
        hulls = merge(slabs(light, error_m, config.shell_m, center), error_m)
        if light is sheet or uncovered(hulls, points) <= COVER_SHARE * error_m:
            return hulls
    return merge(slabs(sheet, error_m, config.shell_m, center), error_m)


def _not_inside_others(hulls: list[Hull], proud_m: float = TOUCHING_M) -> list[Hull]:
    order = sorted(range(len(hulls)), key=lambda i: -hulls[i].volume)
    boxes = [(h.vertices.min(axis=0) - proud_m, h.vertices.max(axis=0) + proud_m) for h in hulls]
    kept: list[int] = []
    for i in order:
        low, high = boxes[i]
        inside = any(
            (boxes[k][0] <= low + proud_m).all()
            and (boxes[k][1] >= high - proud_m).all()
            and float(depth_below(hulls[k], hulls[i].vertices).min()) >= -proud_m
            for k in kept
        )
        if not inside:
            kept.append(i)
    return [hulls[i] for i in sorted(kept)]
