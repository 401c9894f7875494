"""Round parts that move about an upright or a level axis: caps, pot lids, turntables, wheels."""

from __future__ import annotations

import numpy as np

from ...articulation import JointKind
from ...mesh import BoolArray, IntArray
from ...part import PartKind
from ...views.raster import Side
from ..proposal import Motion
from .knobs import is_round
from .movers import Mover
from .scene import FRONT, PLAN, RECT, SIDEWAYS, UP, Scene, quarter_turn

FROM_ABOVE = Side.FRONT.frame.T @ Side.TOP.frame
"""The view whose front is the top of the scene: its y points down, its z to the back."""
HIGHEST = 0.5
"""Of the object's height: a cap, or a wheel."""
LIFT = 0.5
"""Share of its height by which a lid is lifted: visible, since a lid that comes off has no end."""


def find_cap(scene: Scene) -> tuple[Mover, ...]:
    """Find what tops a round body about its upright axis: a cap that turns, a lid that lifts."""
    above = scene.turned(FROM_ABOVE)
    tallest = HIGHEST * scene.size[UP]
    reach = scene.high[:, UP] >= scene.box[1, UP] - 0.25 * scene.size[UP]
    fits = reach & (scene.extents[:, UP] <= tallest) & _is_square(scene)
    for cap in sorted(np.flatnonzero(fits), key=lambda k: -float(np.prod(scene.extents[k, PLAN]))):
        if not is_round(above, int(cap)):
            continue
        group = np.flatnonzero(scene.low[:, UP] >= scene.low[cap, UP] - scene.touch / 2)
        if scene.box[1, UP] - scene.low[cap, UP] <= tallest and _tops_a_body(
            scene, int(cap), group
        ):
            return (_cap(scene, int(cap), group),)
    return ()


def _is_square(scene: Scene) -> BoolArray:
    return scene.square(PLAN) & (scene.extents[:, SIDEWAYS] >= 2.0 * scene.touch)


def _tops_a_body(scene: Scene, cap: int, group: IntArray) -> bool:
    """Tell whether only one body, as wide and coaxial, is below the cap and touches it."""
    rest = np.flatnonzero(scene.without(group))
    if not len(rest):
        return False
    width = float(scene.extents[cap, SIDEWAYS])
    aside = np.linalg.norm((scene.middle[rest] - scene.middle[cap])[:, PLAN], axis=1)
    near = scene.high[rest, UP] >= scene.low[cap, UP] - scene.touch
    below = scene.low[rest, UP] < scene.low[cap, UP] - 0.5 * scene.extents[cap, UP]
    sides = scene.extents[rest][:, PLAN]
    as_wide = (sides.min(axis=1) >= 0.75 * width) & (sides.max(axis=1) <= 1.6 * width)
    body = rest[(aside <= 0.05 * width) & near & below & as_wide & _is_square(scene)[rest]]
    if not len(body) or sides.max() > 1.05 * scene.extents[body][:, PLAN].max():
        return False
    # What stands beside the cap (a spout, a handle) stays; what passes through it would hold it.
    through = scene.high[rest, UP] > scene.high[cap, UP] + scene.touch
    return not bool((through & (aside <= 0.5 * width)).any())


def _cap(scene: Scene, cap: int, group: IntArray) -> Mover:
    width = float(scene.extents[cap, SIDEWAYS])
    origin = scene.middle[cap]
    up = np.eye(3)[UP]
    if float(np.ptp(scene.box_of(group), axis=0).max()) > 1.5 * width:
        guess = ("sticks out from the round top of a round body; assumed to turn by half a turn",)
        motion = Motion(JointKind.REVOLUTE, up, origin, 0.0, np.pi)
        return Mover(PartKind.LEVER, motion, group, guess)
    if _has_knob(scene, cap, group):
        lift = LIFT * float(scene.high[group, UP].max() - scene.low[cap, UP])
        guess = ("lies on a round body and is lifted off; how far is assumed",)
        motion = Motion(JointKind.PRISMATIC, up, origin, 0.0, lift)
        return Mover(PartKind.LID, motion, group, guess)
    guess = ("tops a round body; assumed to turn without end",)
    return Mover(PartKind.CAP, Motion.endless(up, origin), group, guess)


def _has_knob(scene: Scene, cap: int, group: IntArray) -> bool:
    """Tell whether the top quarter of a cap is at most half as wide as the cap."""
    corners = scene.triangles[np.isin(scene.labels, group)].reshape(-1, 3)
    low = float(scene.low[cap, UP])
    high = float(scene.high[group, UP].max())
    top = corners[corners[:, UP] >= high - 0.25 * (high - low)]
    offset = np.linalg.norm((top - scene.middle[cap])[:, PLAN], axis=1)
    return bool(offset.max() <= 0.25 * scene.extents[cap, SIDEWAYS])


def find_turntables(scene: Scene, taken: IntArray) -> tuple[Mover, ...]:
    """Return the one round plate that lies level inside a closed space, as in a microwave oven."""
    width, _, height = scene.extents.T
    free = scene.without(taken)
    flat = free & (width >= 0.3 * scene.size[PLAN].min()) & (height <= 0.15 * width)
    flat &= _is_square(scene) & (scene.high[:, UP] <= scene.box[:, UP].mean())
    above = scene.turned(FROM_ABOVE)
    plates = [int(k) for k in np.flatnonzero(flat) if is_round(above, int(k))]
    if not plates:
        return ()
    plate = max(plates, key=lambda k: (float(width[k]), k))
    slack = np.array([scene.touch, scene.touch, float(width[plate]) * 0.1])
    group = scene.within(scene.low[plate] - slack, scene.high[plate] + slack)
    pieces = np.flatnonzero(group & free)
    if not set(plates) <= set(pieces.tolist()) or not _is_enclosed(scene, plate, pieces):
        return ()
    guess = ("is a round plate inside a closed space; assumed to turn without end",)
    motion = Motion.endless(np.eye(3)[UP], scene.middle[plate])
    return (Mover(PartKind.TURNTABLE, motion, pieces, guess),)


def _is_enclosed(scene: Scene, plate: int, pieces: IntArray) -> bool:
    """Tell whether something stands on all six sides of a plate."""
    start = scene.middle[plate].copy()
    start[UP] = scene.high[pieces, UP].max() + scene.touch
    ways = [(axis, sign) for axis in (*PLAN, UP) for sign in (-1, 1)]
    free = scene.distances(start, ways, pieces)
    far = free[:4].min() >= 0.5 * scene.extents[plate, SIDEWAYS]
    return bool(far and np.isfinite(free).all())


def find_wheels(scene: Scene, taken: IntArray) -> tuple[Mover, ...]:
    """Find two or more equal round pieces that stand upright on the ground."""
    found: list[Mover] = []
    for turns in (0, 1):
        view = scene.turned(quarter_turn(turns)) if turns else scene
        found += [m.seen_from(quarter_turn(turns)) for m in _wheels(view, taken)]
    return tuple(found)


def _wheels(scene: Scene, taken: IntArray) -> list[Mover]:
    width, depth, height = scene.extents.T
    free = scene.without(taken)
    floor = scene.low[:, UP] <= scene.box[0, UP] + 0.1 * height
    shaped = scene.square(RECT) & (depth <= 0.9 * width)
    sized = (height <= HIGHEST * scene.size[UP]) & (height >= 2.0 * scene.touch)
    sized &= (depth >= 0.1 * width) & (depth <= 0.5 * scene.size[FRONT])
    wheels = [
        int(k) for k in np.flatnonzero(free & floor & shaped & sized) if is_round(scene, int(k))
    ]
    wheels = [k for k in wheels if any(_are_alike(scene, k, other) for other in wheels)]
    largest = max((float(height[k]) for k in wheels), default=0.0)
    wheels = [k for k in wheels if height[k] >= 0.4 * largest]
    done: set[int] = set()
    movers = []
    for k in sorted(wheels, key=lambda k: (-float(height[k] * depth[k]), k)):
        if k in done:
            continue
        slack = 0.02 * height[k]
        inside = scene.within(scene.low[k] - slack, scene.high[k] + slack)
        pieces = np.union1d(np.flatnonzero(inside & free), [k])
        done |= {int(p) for p in pieces}
        guess = ("is round and stands on the ground with its like; assumed to roll",)
        motion = Motion.endless(np.eye(3)[FRONT], scene.middle[k])
        movers.append(Mover(PartKind.WHEEL, motion, pieces, guess))
    return movers


def _are_alike(scene: Scene, a: int, b: int) -> bool:
    """Return whether two pieces are as high, and not in one place as a tyre and its rim are."""
    height = scene.extents[a, UP]
    apart = np.abs(scene.middle[a] - scene.middle[b]).max() > 0.5 * height
    return bool(apart and abs(scene.extents[b, UP] - height) <= 0.05 * height)
