"""Doors and drawers in the front of a scene."""

from __future__ import annotations

import numpy as np

from ...articulation import JointKind
from ...mesh import FloatArray, IntArray
from ...part import OpensBy, PartKind
from ..proposal import Motion
from .behind import FrontFace, covers, look_behind
from .hinge_sides import WIDE, hinge_side
from .knobs import find_knobs
from .mounted import is_crowded
from .movers import DOOR_LIMIT, DRAWER_SHARE, Mover
from .panels import find_panels
from .scene import FRONT, SIDEWAYS, UP, Scene
from .slab import FrontSlab
from .sweep import free_turn, surface_points

LEAST_TURN = np.radians(20.0)
MANY_BUTTONS = 6
KNUCKLES = 0.08
"""Radius of what belongs to a hinge, over the panel's shorter side."""


def find_fronts(scene: Scene) -> tuple[Mover, ...]:
    """Find the doors and drawers seen from the front, top to bottom, left to right."""
    panels = find_panels(scene)
    candidates = [look_behind(scene, panel, panels) for panel in panels]
    sure = [c for c in candidates if _is_sure(scene, c)]
    sure += [c for c in candidates if c not in sure and _has_handled_peer(scene, c, candidates)]
    bare = [c for c in sure if c.panel.is_box and c.panel.handle is None]
    if len(bare) == 1:
        sure.remove(bare[0])
    fronts = sure + [
        c for c in candidates if c not in sure and _is_plausible(scene, c, sure, candidates)
    ]
    fronts = _drop_overlapping(fronts)
    fronts.sort(key=lambda f: scene.reading_place(f.panel.low, f.panel.high))
    points, owner = surface_points(scene)
    movers = [_mover(scene, front, fronts, points, owner) for front in fronts]
    found = tuple(m for m in movers if m is not None)
    if not any(m.kind is PartKind.DOOR for m in found):
        return found
    return found + find_knobs(scene, np.concatenate([m.pieces for m in found]))


def _is_sure(scene: Scene, front: FrontFace) -> bool:
    """Return a drawer's box, or a handle on something that closes a space."""
    panel = front.panel
    handle = panel.handle
    if is_crowded(scene, panel):
        return False
    if panel.is_box:
        return front.walls >= 3 and (handle is not None or front.walls >= 4)
    if front.has_box:
        small = panel.area <= 0.8 * scene.front_area
        return handle is not None or bool(small and front.walls >= 4)
    if handle is None or _is_control_panel(scene, panel, handle):
        return False
    if _has_carrying_grip(scene, panel, handle):
        return False
    deep = scene.size[FRONT] >= 2.0 * panel.depth
    # Of a lone door one wall may be missing, as below a sink or before a wall.
    alone = panel.has_side_handle and panel.area >= 0.6 * scene.front_area
    wanted = 4 if alone else 5
    return bool(deep and (front.solid or (front.walls >= wanted and front.roomy)))


def _has_handled_peer(scene: Scene, front: FrontFace, candidates: list[FrontFace]) -> bool:
    """Tell whether another panel with a handle is beside one whose back may be open."""
    open_backed = [
        c
        for c in candidates
        if c.panel.handle is not None
        and c.walls >= 4
        and c.roomy
        and not _is_control_panel(scene, c.panel, c.panel.handle)
    ]
    return front in open_backed and any(
        c is not front and _beside(c.panel, front.panel, scene) for c in open_backed
    )


def _is_control_panel(scene: Scene, panel: FrontSlab, handle: FloatArray) -> bool:
    """Tell whether many small things, and no bar, are on the panel: knobs and buttons."""
    mounted = np.array(panel.mounted, dtype=np.int64)
    width, _, height = scene.extents[mounted].T
    buttons = int((np.maximum(width, height) <= 0.2 * max(panel.width, panel.height)).sum())
    bar = float((handle[1] - handle[0])[[SIDEWAYS, UP]].max())
    return buttons >= MANY_BUTTONS and bar < 0.4 * max(panel.width, panel.height)


def _has_carrying_grip(scene: Scene, panel: FrontSlab, handle: FloatArray) -> bool:
    """Return a grip in the middle of a panel that is no drawer: a crate's side.

    The panel is all of the front, or too narrow for a drawer.
    """
    all_front = panel.area >= 0.65 * scene.front_area
    offset = np.abs(handle.mean(axis=0) - panel.center)
    central = bool(offset[SIDEWAYS] <= 0.1 * panel.width and offset[UP] <= 0.15 * panel.height)
    return central and (all_front or panel.width < WIDE * panel.height)


def _is_plausible(
    scene: Scene, front: FrontFace, sure: list[FrontFace], candidates: list[FrontFace]
) -> bool:
    """Tell whether a panel without handle closes a real space, beside others or alone."""
    panel = front.panel
    deep = front.depth >= max(2.0 * panel.depth, 0.3 * float(scene.size[FRONT]))
    closes = front.walls >= 5 and front.roomy and deep
    if panel.handle is not None or panel.is_box or is_crowded(scene, panel) or not closes:
        return False
    if max(panel.width, panel.height) > 6.0 * min(panel.width, panel.height):
        return False
    if any(c.panel.handle is not None for c in sure):
        return False
    peers = [
        c for c in candidates if c is not front and c.walls >= 5 and _beside(c.panel, panel, scene)
    ]
    return bool(peers) or _stands_alone(scene, panel)


def _stands_alone(scene: Scene, panel: FrontSlab) -> bool:
    """Tell whether one panel is most of the front, foremost, without a twin at the back."""
    if panel.area < 0.6 * scene.front_area or panel.depth < 0.02 * scene.size[FRONT]:
        return False
    others = scene.without(panel.pieces)
    width, depth, height = scene.extents[others].T
    ahead = scene.low[others, FRONT] < panel.low[FRONT] + 0.25 * panel.depth
    thick = panel.depth >= 0.06 * scene.size[FRONT]
    # Beside a thick door there may be a body that is flush with it, as beside the door of a
    # microwave oven.
    flush = (
        thick
        & (depth >= 0.6 * scene.size[FRONT])
        & (scene.low[others, FRONT] > panel.low[FRONT] - 2.0 * scene.touch)
    )
    inside = scene.within(panel.low - scene.touch, panel.high + scene.touch)[others]
    if (ahead & ~flush & ~inside & (width * height >= 0.08 * panel.area)).any():
        return False
    thin = scene.extents[others, FRONT] <= max(2.0 * panel.depth, 4.0 * scene.touch)
    far = scene.high[others, FRONT] >= scene.box[1, FRONT] - 0.1 * scene.size[FRONT]
    return bool((width * height)[thin & far].sum() < 0.7 * panel.area)


def _beside(a: FrontSlab, b: FrontSlab, scene: Scene) -> bool:
    """Tell whether two panels of one plane line up in a row or a column, a hair apart."""
    if min(abs(a.low[FRONT] - b.low[FRONT]), abs(a.high[FRONT] - b.high[FRONT])) > scene.touch:
        return False
    for along, across in ((SIDEWAYS, UP), (UP, SIDEWAYS)):
        gap = max(a.low[along] - b.high[along], b.low[along] - a.high[along])
        level = abs(a.low[across] - b.low[across]) + abs(a.high[across] - b.high[across])
        sides = sorted((a.high[along] - a.low[along], b.high[along] - b.low[along]))
        if sides[0] < 0.85 * sides[1]:
            continue
        if -scene.touch <= gap <= 0.08 * scene.size[along] and level <= 4.0 * scene.touch:
            return True
    return False


def _drop_overlapping(fronts: list[FrontFace]) -> list[FrontFace]:
    """Keep the first of panels over each other, then the larger."""
    kept: list[FrontFace] = []
    for front in fronts:
        if all(covers(front.panel, other.panel) < 0.3 for other in kept):
            kept.append(front)
    return kept


def _mover(
    scene: Scene, front: FrontFace, fronts: list[FrontFace], points: FloatArray, owner: IntArray
) -> Mover | None:
    panel = front.panel
    pieces = front.pieces
    weight = panel.area * (3.0 if panel.handle is not None else 1.0)
    side, guesses = hinge_side(scene, front, fronts)
    if side is OpensBy.OUT:
        reach = front.depth if not front.solid else 0.5 * float(scene.size[FRONT])
        travel = DRAWER_SHARE * min(reach, float(scene.box[1, FRONT] - panel.low[FRONT]))
        origin = panel.point(0.5, panel.low[FRONT], 0.5)
        if travel < scene.touch:
            return None
        motion = Motion(JointKind.PRISMATIC, np.array([0.0, -1.0, 0.0]), origin, 0.0, travel)
        return Mover(PartKind.DRAWER, motion, pieces, guesses, weight, panel.outline(side))
    surroundings = points[~np.isin(owner, pieces)]
    axis, origin, turn = _hinge(scene, panel, side, surroundings)
    if turn < LEAST_TURN:
        return None
    if turn < np.radians(60.0):
        guesses = (
            *guesses,
            f"opens only {np.degrees(turn):.0f} degrees before it meets its surroundings",
        )
    motion = Motion(JointKind.REVOLUTE, axis, origin, 0.0, turn)
    return Mover(PartKind.DOOR, motion, pieces, guesses, weight, panel.outline(side))


def _hinge(
    scene: Scene, panel: FrontSlab, side: OpensBy, surroundings: FloatArray
) -> tuple[FloatArray, FloatArray, float]:
    """Return the axis, origin and free turn [rad] of a hinge at one edge.

    The back corner, or the front one if it opens wider.
    """
    across, edge, sign = {
        OpensBy.LEFT: (SIDEWAYS, panel.low, -1.0),
        OpensBy.RIGHT: (SIDEWAYS, panel.high, 1.0),
        OpensBy.BOTTOM: (UP, panel.low, 1.0),
        OpensBy.TOP: (UP, panel.high, -1.0),
    }[side]
    axis = np.zeros(3)
    axis[UP if across == SIDEWAYS else SIDEWAYS] = sign
    margin = np.minimum(np.array([1.0, 0.5, 1.0]) * scene.touch, 0.2 * (panel.high - panel.low))
    box = np.stack([panel.low + margin, panel.high - margin])
    # The upright doors of fridges stand in front of the body, hinge included.
    limit = np.pi if across == SIDEWAYS and _is_thick_door(scene, panel) else DOOR_LIMIT
    best_origin = panel.center
    best_turn = -1.0
    for depth in (panel.high[FRONT], panel.low[FRONT]):
        origin = panel.center.copy()
        origin[across] = edge[across]
        origin[FRONT] = depth
        turn = free_turn(
            _without_knuckles(surroundings, origin, axis, panel), box, axis, origin, limit
        )
        if turn > best_turn:
            best_origin = origin
            best_turn = turn
    return axis, best_origin, best_turn


def _without_knuckles(
    points: FloatArray, origin: FloatArray, axis: FloatArray, panel: FrontSlab
) -> FloatArray:
    """Drop surroundings about the axis: hinges turn within their own barrels."""
    offset = points - origin
    radial = np.linalg.norm(offset - np.outer(offset @ axis, axis), axis=1)
    return np.asarray(points[radial > KNUCKLES * min(panel.width, panel.height)])


def _is_thick_door(scene: Scene, panel: FrontSlab) -> bool:
    """Return a door as thick as a fridge's, on a body as tall and deep as one."""
    upright = (
        scene.size[UP] >= 1.2 * scene.size[SIDEWAYS]
        and scene.size[FRONT] >= 0.6 * scene.size[SIDEWAYS]
    )
    return bool(upright and panel.depth >= max(0.045 * scene.size[FRONT], 0.065 * panel.width))
