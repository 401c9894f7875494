"""Which moved parts are bare plates: fronts with no body of their own behind them."""

from __future__ import annotations

import numpy as np

from ...articulation import Articulation, Joint, JointKind
from ...geometry.crossings import Raster, Side, crossings
from ...mesh import FloatArray, Mesh

#: Who takes parts and joints as they are stated.
STATED = "annotated"
#: What opens a side moves along its outward normal to this cosine.
OUTWARD = 0.8
#: A drawer deeper than this share of the object has a box of its own.
PLATE = 0.3
#: A door is in front of something solid where so many rays meet a surface within this share of the
#: object's depth behind it.
SOLID = 0.6
NEAR = 0.06
#: Along the longest extent of an object [pixels].
PIXELS = 96
#: Of a part's rectangle this is left out on every side: frames, rims, hinges.
INSET = 0.15


def plates(articulation: Articulation) -> dict[int, Side]:
    """Return the thin parts that open an upright side, hung on the body, and that side.

    None where somebody stated the parts: what was modelled so is meant so.
    """
    if articulation.articulator == STATED:
        return {}
    found = {}
    for joint in articulation.joints:
        hangs = joint.parent == 0 and joint.movable and joint.kind is not JointKind.CONTINUOUS
        if not hangs or not len(articulation.parts[joint.child].faces):
            continue
        part = articulation.part_mesh(joint.child)
        side = _opened_side(part, joint)
        if side is None:
            continue
        away = side.frame[2]
        depth = float(np.ptp(articulation.mesh.vertices @ away))
        if float(np.ptp(part.vertices @ away)) <= PLATE * depth:
            found[joint.child] = side
    return found


def bare_fronts(articulation: Articulation) -> tuple[int, ...]:
    """Drawers that are front plates alone, and doors of something that is solid behind them."""
    return tuple(
        part
        for part, side in plates(articulation).items()
        if articulation.joints[part - 1].kind is JointKind.PRISMATIC
        or _solid_behind(articulation, part, side) >= SOLID
    )


def _opened_side(part: Mesh, joint: Joint) -> Side | None:
    """Return the upright side that a part moves out of."""
    motion = joint.axis
    if joint.kind is JointKind.REVOLUTE:
        motion = np.cross(joint.axis, part.bounds.mean(axis=0) - joint.origin)
        motion = motion * np.sign(joint.upper + joint.lower)
    length = float(np.linalg.norm(motion))
    upright = [side for side in Side if side not in (Side.TOP, Side.BOTTOM)]
    best = max(upright, key=lambda side: -float(side.frame[2] @ motion))
    return best if -float(best.frame[2] @ motion) > OUTWARD * length > 0.0 else None


def _solid_behind(articulation: Articulation, part: int, side: Side) -> float:
    """Share of a plate behind whose face there is soon a surface of something else, 0 to 1."""
    mesh = articulation.mesh
    crossed = crossings(mesh, Raster.around(mesh, side, PIXELS))
    own = np.zeros(len(mesh.faces), dtype=np.bool_)
    own[articulation.parts[part].faces] = True
    local = articulation.part_mesh(part).vertices @ side.frame.T
    window = _window(crossed.raster, local)
    far = float(local[:, 2].max()) - crossed.raster.near
    reach = far + NEAR * float(np.ptp(mesh.vertices @ side.frame[2]))
    mine = own[crossed.face]
    front = np.full(crossed.raster.rows * crossed.raster.columns, np.inf)
    np.minimum.at(front, crossed.pixel[mine], crossed.depth[mine])
    behind = ~mine & (crossed.depth > front[crossed.pixel]) & (crossed.depth <= reach)
    met = np.zeros(len(front), dtype=np.bool_)
    met[crossed.pixel[behind]] = True
    looked = window & np.isfinite(front)
    return float(met[looked].mean()) if looked.any() else 0.0


def _window(raster: Raster, local: FloatArray) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Return the pixels well within a part's rectangle, shape [rows * columns]."""
    low = local[:, :2].min(axis=0)
    high = local[:, :2].max(axis=0)
    inset = INSET * (high - low)
    columns = raster.low[0] + np.arange(raster.columns) * raster.pixel
    rows = raster.low[1] + np.arange(raster.rows) * raster.pixel
    across = (columns > low[0] + inset[0]) & (columns < high[0] - inset[0])
    up = (rows > low[1] + inset[1]) & (rows < high[1] - inset[1])
    return np.asarray((up[:, None] & across[None, :]).ravel())
