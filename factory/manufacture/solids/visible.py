"""The mesh of an object with its inner faces, and a record of each."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...articulation import Articulation
from ...geometry.colors import linear_of
from ...geometry.rows import distinct_rows
from ...geometry.triangles import areas_of
from ...mesh import BoolArray, FloatArray, IntArray, Material, Mesh, unit_rows
from ..decompose.outside import outside
from .boards import SHELF_M, WALL_M
from .panel import FlatPanel
from .seam import CutSkin
from .surfaces import boundary, flipped, inside_of, outline_of, outside_of, plate, rectangle, rim
from .work import Workpiece

#: What is shown of the body around a panel lies so near to the body's pieces [m].
BACKED_M = 0.01
#: Points spread within a triangle, as weights of its corners, shape [10, 3].
SPREAD = np.array([(i, j, 12 - i - j) for i in range(1, 12, 3) for j in range(1, 12 - i, 3)]) / 12


def panel_surfaces(work: Workpiece, part: int) -> None:
    """Add a panel's back and rim, the opening that it leaves, hollows, and a drawer's box."""
    panel = work.panels[part]
    own = work.skin.of_part(part) @ panel.side.frame.T
    column = panel.reach(0.0, panel.back)
    edges = boundary(own)
    thickness = panel.thickness
    strips = rim(edges, column, panel.back, ~panel.open)
    work.add(part, strips, "rim", panel.rule, panel=panel, thickness=thickness)
    start = panel.back + work.config.behind_m
    opening = _backed(work, panel, flipped(rim(edges, column, start, ~panel.shared & ~panel.open)))
    work.add(0, opening, "opening", panel.rule, panel=panel, thickness=thickness)
    points = own.reshape(-1, 3)
    if panel.is_lid:
        # Straps stand out above the seam; cuts along it left corners all round.
        points = points[points[:, 2] > panel.back - work.views[panel.side].raster.pixel]
    outline = outline_of(points)
    if len(outline) < 3:
        return
    # Frames bound it.
    outline = np.clip(outline, column.low[:2], column.high[:2])
    inner = work.lids.get(part, ())
    if not panel.through:
        back = plate(outline, [rectangle(box) for box in inner[:1]], panel.back)
        work.add(part, back, "slab back", panel.rule, panel=panel, thickness=thickness)
    hollows = work.hollows.get(part, ())
    wall = work.config.wall_m
    if work.closed_behind(part):
        ring = flipped(plate(outline, [rectangle(box) for box in hollows[:1]], start))
        ring = _backed(work, panel, ring)
        work.add(0, ring, "frame", panel.rule, panel=panel, thickness=wall)
        if hollows:
            walls = inside_of(hollows, hollows[0].low[2])
            depth = hollows[-1].high[2] - hollows[0].low[2]
            work.add(0, walls, "hollow", "walls", panel=panel, thickness=wall, depth=depth)
        shelves = outside_of(work.shelves.get(part, ()))
        work.add(0, shelves, "shelf", "usual", panel=panel, thickness=SHELF_M)
    if inner:
        walls = inside_of(inner, inner[0].high[2])
        depth = inner[0].high[2] - inner[-1].low[2]
        work.add(part, walls, "lid hollow", "walls", panel=panel, thickness=wall, depth=depth)
    boards = work.boards.get(part, ())
    if boards:
        box = outside_of(boards)
        depth = boards[0].size[2]
        work.add(part, box, "drawer box", "hollow", panel=panel, thickness=WALL_M, depth=depth)


def _backed(work: Workpiece, panel: FlatPanel, triangles: FloatArray) -> FloatArray:
    """Return the triangles around a panel that lie mostly on the body's pieces."""
    if not len(triangles):
        return triangles
    points = np.einsum("kc,ncd->nkd", SPREAD, triangles).reshape(-1, 3) @ panel.side.frame
    on = outside(work.hulls.get(0, ()), points) < BACKED_M
    return np.asarray(triangles[on.reshape(len(triangles), -1).mean(axis=1) >= 0.5])


def bump_surfaces(work: Workpiece, part: int) -> None:
    """Add the base of a knob, or all of a wheel."""
    bump = work.bumps[part]
    corners = bump.hull.vertices[bump.hull.faces]
    if bump.normal is None:
        work.add(part, corners, "wheel", bump.rule)
        return
    edges = boundary(work.skin.of_part(part))
    on_base = (np.abs(edges @ bump.normal - bump.base) < 1e-5).all(axis=1)
    across, along = _across(bump.normal)
    points = edges[on_base].reshape(-1, 3)
    flat = np.column_stack([points @ across, points @ along])
    outline = outline_of(flat) if len(flat) >= 3 else flat
    if len(outline) < 3:
        return
    lid = outline[:, :1] * across + outline[:, 1:] * along + bump.base * bump.normal
    fan = np.stack([np.repeat(lid[:1], len(lid) - 2, axis=0), lid[2:], lid[1:-1]], axis=1)
    work.add(part, fan, "knob base", bump.rule)
    work.add(work.host(part), flipped(fan), "knob base", bump.rule)


def _across(normal: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return two directions that span a plane, right-handed with its normal."""
    first = np.cross(normal, np.eye(3)[int(np.abs(normal).argmin())])
    first = first / np.linalg.norm(first)
    return first, np.cross(normal, first)


def kept_skin(work: Workpiece) -> CutSkin:
    """Return the mesh without what of the body lies in gaps and hollows."""
    skin = work.skin
    gone = np.zeros(len(skin.face), dtype=bool)
    middles = skin.middles
    for part, panel in work.panels.items():
        local = middles @ panel.side.frame.T
        column = panel.reach(0.0, panel.back + work.config.behind_m)
        hollows = work.hollows.get(part, ()) if work.closed_behind(part) else ()
        for box in (column, *hollows):
            gone |= box.holds(local, -1e-6) & (skin.part == 0)
        for box in work.lids.get(part, ()):
            gone |= box.holds(local, -1e-6) & (skin.part == part)
    # A part keeps at least a face of its own.
    counts = np.bincount(skin.part[~gone], minlength=len(work.source.parts))
    kept: BoolArray = ~gone | (counts[skin.part] == 0)
    return skin.chosen(kept)


def meshed(work: Workpiece) -> Articulation:
    """Return the articulation over the cut mesh and all inner faces, in the working frame."""
    skin = kept_skin(work)
    mesh = work.source.mesh
    materials = list(mesh.materials)
    corners = [skin.corners]
    part = [skin.part]
    material = [mesh.face_material[skin.face]]
    for (index, lined), triangles in sorted(work.added.items()):
        inner = np.concatenate(triangles)
        inner = inner[areas_of(inner) > 1e-12]
        material.append(np.full(len(inner), _material(work, index, lined, materials)))
        corners.append(inner)
        part.append(np.full(len(inner), index))
    count = sum(len(each) for each in corners) - len(skin.face)
    made = _welded(
        np.concatenate(corners),
        _mixed(mesh.corner_uv, skin, count),
        _mixed(mesh.corner_normals, skin, count),
        np.concatenate(material),
        tuple(materials),
    )
    owners = np.concatenate(part)
    parts = tuple(
        replace(each, faces=np.flatnonzero(owners == index))
        for index, each in enumerate(work.source.parts)
    )
    return replace(work.source, mesh=made, parts=parts, joints=tuple(work.joints))


def _mixed(values: FloatArray | None, skin: CutSkin, count: int) -> FloatArray | None:
    """Return corner values of pieces of triangles, and NaN for ``count`` triangles after them."""
    if values is None:
        return None
    mixed = np.einsum("nkc,ncd->nkd", skin.weights, values[skin.face])
    return np.concatenate([mixed, np.full((count, 3, values.shape[2]), np.nan)])


def _welded(
    corners: FloatArray,
    uv: FloatArray | None,
    normals: FloatArray | None,
    material: IntArray,
    materials: tuple[Material, ...],
) -> Mesh:
    points = np.round(corners.reshape(-1, 3), 7)
    first, index = distinct_rows(points)
    unit = None if normals is None else unit_rows(normals)
    return Mesh(points[first], index.reshape(-1, 3), uv, unit, material, materials)


def _material(work: Workpiece, part: int, lined: bool, materials: list[Material]) -> int:
    """Add the plain material of a part's inner faces, and return where it is."""
    liner = work.usual.liner if lined else None
    name = f"{'inner' if liner is None else 'liner'}_{work.name(part)}"
    color = _color(work, part) if liner is None else _painted(liner)
    materials.append(Material(name, color))
    return len(materials) - 1


def _painted(color: str) -> tuple[float, float, float, float]:
    """Return a colour written as ``#rrggbb``, linear."""
    return _rounded(linear_of(np.array(list(bytes.fromhex(color[1:]))) / 255.0))


def _color(work: Workpiece, part: int) -> tuple[float, float, float, float]:
    """Return the mean colour of a part as seen from all sides, linear."""
    seen = [view.color[view.part == part] for view in work.views.values()]
    pixels = np.concatenate(seen)
    if not len(pixels):
        return (0.7, 0.7, 0.7, 1.0)
    return _rounded(linear_of(pixels).mean(axis=0))


def _rounded(color: FloatArray) -> tuple[float, float, float, float]:
    red, green, blue = (round(float(value), 4) for value in color)
    return (red, green, blue, 1.0)
