"""The panels among some parts, and the mesh cut along their outlines."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ...articulation import Articulation
from ...geometry.posing import face_parts
from ...geometry.triangles import doubled_normals
from ...mesh import BoolArray, FloatArray
from ...views.raster import Side, side_facing
from ...views.view import View
from ..poses import held_by, joints_above
from .bump import Bump, find_bump
from .panel import BESIDE_M, FlatPanel, ended_at, find_panel, opens
from .seam import CutSkin, cut
from .skin import border

#: An inner side this close behind a panel's back is the panel's own [m].
OWN_BACK_M = 0.04
#: What is its own lies so far within its edges [m].
INSET_M = 0.01


def recognize(
    articulation: Articulation, parts: tuple[int, ...], views: Mapping[Side, View], behind: float
) -> tuple[dict[int, FlatPanel], CutSkin]:
    """Measure the panels among some patches of one surface and cut the mesh along them.

    A part whose faces all lie within another panel's claim is no panel, and keeps them. The object
    is in the working frame, seen on ``views``, and ``behind`` the gap behind a panel [m].

    Returns:
        The panels by part, and the mesh cut along their outlines and labelled anew.
    """
    panels: dict[int, FlatPanel] = {}
    for index in parts:
        joint = articulation.joints[index - 1]
        given = articulation.parts[index].panel
        if given is None or not opens(joint, given):
            continue
        # What hangs on a panel, directly or not, is none.
        if any(above.parent in panels for above in joints_above(articulation, index)):
            continue
        view = views.get(side_facing(given.outward))
        if view is None:
            continue
        panel = find_panel(articulation, index, view, views.get(side_facing(-given.outward)))
        if panel is not None:
            panels[index] = panel
    panels = _apart(panels)
    part = face_parts(articulation)
    skin = CutSkin.of(articulation.mesh, part)
    for panel in panels.values():
        skin = _claimed(skin, panel, set(panels) | {0}, behind)
    lost = [index for index in panels if not (skin.part == index).any()]
    panels = {index: panel for index, panel in panels.items() if index not in lost}
    own = part[skin.face]
    return panels, replace(skin, part=np.where(np.isin(own, lost), own, skin.part))


def _apart(panels: dict[int, FlatPanel]) -> dict[int, FlatPanel]:
    """Return the rectangles of one side that overlap or nearly meet, both ended at the middle."""
    result = dict(panels)
    order = sorted(result)
    for number, a in enumerate(order):
        for b in order[:number]:
            one = result[a]
            other = result[b]
            low = np.maximum(one.low, other.low)
            high = np.minimum(one.high, other.high)
            deep = one.front > other.back or other.front > one.back
            axis = int(np.argmin(high - low))
            meet = high[axis] - low[axis] > -BESIDE_M and high[1 - axis] > low[1 - axis]
            if one.side is not other.side or deep or not meet:
                continue
            middle = float(low[axis] + high[axis]) / 2.0
            first = one.low[axis] + one.high[axis] < other.low[axis] + other.high[axis]
            result[a] = _ended(one, 2 * axis + int(first), middle)
            result[b] = _ended(other, 2 * axis + int(not first), middle)
    return result


def _ended(panel: FlatPanel, edge: int, at: float) -> FlatPanel:
    shared = panel.shared.copy()
    shared[edge] = True
    return replace(ended_at(panel, edge, at), shared=shared)


def _claimed(skin: CutSkin, panel: FlatPanel, claimants: set[int], behind: float) -> CutSkin:
    """Return the mesh cut along a panel's sides and back; faces within are the panel's.

    Faces there of something else that moves, a knob or an inner drawer, stay with it.
    """
    # Behind a leaf that goes through is its other handle.
    column = panel.reach(0.0, np.inf if panel.through else panel.back)
    frame = panel.side.frame
    wide = panel.reach(0.0, panel.back + behind)
    planes = [(axis, float(end)) for axis in (0, 1) for end in (wide.low[axis], wide.high[axis])]
    room = wide.turned(frame.T)
    near = skin.touching(room)
    pieces = skin.chosen(near)
    for axis, end in (*planes, (2, panel.back), (2, panel.back + behind)):
        pieces = cut(pieces, frame[axis], end, pieces.touching(room))
    skin = skin.chosen(~near).joined(pieces)
    middles = skin.middles @ frame.T
    own_back = panel.within(INSET_M, panel.back, panel.back + OWN_BACK_M)
    lining = _inner_side(skin, frame) & own_back.holds(middles) & ~_beyond(skin, panel)
    inside = column.holds(middles) | lining
    own = skin.part == panel.part
    part = skin.part.copy()
    part[inside & np.isin(part, list(claimants - {panel.part}))] = panel.part
    fitted = panel.within(INSET_M, panel.back).holds(middles) & (not panel.slides)
    # Straps and locks stand out of a lid; above its seam is nothing else.
    proud = (middles[:, 2] <= panel.back) & panel.is_lid
    part[own & ~inside & ~fitted & ~proud] = 0
    return replace(skin, part=part)


def _beyond(skin: CutSkin, panel: FlatPanel) -> BoolArray:
    """Return the triangles that reach beyond a panel's edges: a frame's or a neighbour's."""
    places = skin.corners @ panel.side.frame[:2].T
    low = places.min(axis=1) < panel.low - INSET_M
    high = places.max(axis=1) > panel.high + INSET_M
    return np.asarray((low | high).any(axis=1))


def _inner_side(skin: CutSkin, frame: FloatArray) -> BoolArray:
    """Return the triangles that look away from a side's viewer."""
    normals = doubled_normals(skin.corners)
    return np.asarray(normals @ frame[2] > 0.5 * np.linalg.norm(normals, axis=1))


def recognize_bumps(
    articulation: Articulation, parts: list[int]
) -> tuple[dict[int, Bump], list[int]]:
    """Return the knobs, buttons and wheels among some parts; and those that are none."""
    edges, both = border(articulation.mesh, face_parts(articulation))
    bumps: dict[int, Bump] = {}
    rest: list[int] = []
    for index in parts:
        rim = articulation.mesh.vertices[np.unique(edges[(both == index).any(axis=1)])]
        points = articulation.part_mesh(index).vertices
        bump = find_bump(points, rim, articulation.joints[index - 1])
        if bump is None:
            rest.append(index)
        else:
            bumps[index] = bump
    return bumps, rest


def cut_bases(skin: CutSkin, bumps: dict[int, Bump], articulation: Articulation) -> CutSkin:
    """Return the mesh cut where knobs begin; faces below belong to the part that carries them."""
    for index, bump in bumps.items():
        if bump.normal is None:
            continue
        own = skin.part == index
        skin = cut(skin, bump.normal, bump.base, own)
        below = (skin.part == index) & (skin.middles @ bump.normal < bump.base)
        if not below.all():
            host = held_by(articulation, index) or 0
            skin = replace(skin, part=np.where(below, host, skin.part))
    return skin
