"""Lids of chests and bins, and the screens of closed laptops."""

from dataclasses import dataclass, replace

import numpy as np

from ...articulation import JointKind
from ...mesh import FloatArray, IntArray
from ...part import PartKind
from ..proposal import Motion
from .movers import Mover
from .scene import FRONT, PLAN, SIDEWAYS, UP, Scene
from .sweep import free_turn, surface_points

COVERING = 0.65
"""Share of the object, seen from above, that a lid covers at least."""
LIMITS = {PartKind.LID: np.radians(100.0), PartKind.SCREEN: np.radians(120.0)}
LEAST_TURN = np.radians(45.0)
LEAST_KEYS = 20
SIDES = ((FRONT, 1), (FRONT, -1), (SIDEWAYS, 1), (SIDEWAYS, -1))


@dataclass(frozen=True)
class Cover:
    """What may be a lid.

    Attributes:
        low, high: box of its plate, view frame [m], shape [3].
        pieces: the plate, its rim, and what sits on it.
    """

    low: FloatArray
    high: FloatArray
    pieces: IntArray

    @property
    def center(self) -> FloatArray:
        """Return the middle of the box [m], shape [3]."""
        return np.asarray((self.low + self.high) / 2.0)


def find_lid(scene: Scene) -> tuple[Mover, ...]:
    """Return the one lid of the object as a tuple of one, or nothing."""
    slab = _top_slab(scene)
    if slab is not None and scene.size[UP] <= 0.2 * min(scene.size[PLAN]):
        return _screen(scene, slab)
    covers = (
        [] if slab is None else [Cover(scene.low[slab], scene.high[slab], _hanging_on(scene, slab))]
    )
    for cover in (*covers, *_above_a_cut(scene)):
        if not _closes_empty_body(scene, cover):
            continue
        tab = _tab(scene, cover)
        if tab is None and scene.size[UP] > 0.8 * max(scene.size[PLAN]):
            continue
        side, guess = _hinge_side(scene, cover, tab)
        return _hinged(scene, cover, side, PartKind.LID, guess)
    return ()


def _top_slab(scene: Scene) -> int | None:
    """Return the highest flat piece that covers most of the object, seen from above."""
    width, depth, height = scene.extents.T
    plan = width * depth
    flat = height <= 0.35 * np.minimum(width, depth)
    index = np.flatnonzero(flat & (plan >= COVERING * scene.size[SIDEWAYS] * scene.size[FRONT]))
    if not len(index):
        return None
    best = int(index[np.argmax(scene.high[index, UP])])
    bulky = plan >= 0.25 * plan[best]
    bulky[best] = False
    below = scene.high[bulky, UP].max(initial=-np.inf)
    return (
        best
        if below <= scene.high[best, UP] + scene.touch / 4
        and scene.low[best, UP] > scene.box[0, UP]
        else None
    )


def _hanging_on(scene: Scene, slab: int) -> IntArray:
    """Return the slab, its rim and what sits on it: shallow pieces that touch it."""
    shallow = scene.low[:, UP] >= scene.low[slab, UP] - 0.15 * scene.size[UP]
    reached = np.zeros(len(scene.low), dtype=bool)
    reached[slab] = True
    margin = scene.touch / 2
    for _ in range(4):
        for k in np.flatnonzero(reached):
            near = (scene.low <= scene.high[k] + margin).all(axis=1) & (
                scene.high >= scene.low[k] - margin
            ).all(axis=1)
            reached |= near & shallow
    return np.flatnonzero(reached)


def _above_a_cut(scene: Scene) -> tuple[Cover, ...]:
    """Return a lid of several pieces: all above a height that no piece crosses."""
    hair = scene.touch / 8.0
    floor = scene.box[0, UP] + 0.5 * scene.size[UP]
    for height in np.unique(scene.low[scene.low[:, UP] >= floor, UP]):
        crossing = (scene.low[:, UP] < height - hair) & (scene.high[:, UP] > height + hair)
        above = np.flatnonzero(scene.low[:, UP] >= height - hair)
        if crossing.any():
            continue
        low = scene.low[above].min(axis=0)
        high = scene.high[above].max(axis=0)
        widest = scene.extents[above][:, PLAN].max(axis=0)
        if np.prod(widest) >= COVERING * scene.size[SIDEWAYS] * scene.size[FRONT]:
            return (Cover(low, high, above),)
    return ()


def _closes_empty_body(scene: Scene, cover: Cover) -> bool:
    """Tell whether walls stand all around below the cover, over a bottom and nothing else."""
    sides = cover.high - cover.low
    top = cover.low[UP] - scene.touch / 4
    depths = []
    for u in (0.22, 0.5, 0.77):
        for v in (0.24, 0.5, 0.79):
            start = np.array([cover.low[0] + u * sides[0], cover.low[1] + v * sides[1], top])
            depths.append(scene.first_hit(start, UP, -1, cover.pieces)[0])
    if not np.isfinite(depths).all() or min(depths) < 0.6 * (top - scene.box[0, UP]):
        return False
    middle = cover.center
    for share in (0.15, 0.5, 0.85):
        middle[UP] = top - share * min(depths)
        for axis, sign in SIDES:
            distance, _ = scene.first_hit(middle, axis, sign, cover.pieces)
            if not 0.25 * scene.size[axis] <= distance < np.inf:
                return False
    return True


def _tab(scene: Scene, cover: Cover) -> FloatArray | None:
    """Return the middle of a latch or grip at the lid's edge [m]; ``None`` if none or central."""
    sides = (cover.high - cover.low)[PLAN]
    small = (scene.extents[cover.pieces][:, PLAN] <= 0.5 * sides).all(axis=1)
    middle = (scene.low[cover.pieces] + scene.high[cover.pieces])[:, PLAN] / 2.0
    offset = np.abs(middle - cover.center[PLAN]) / sides
    at_edge = (offset.max(axis=1) > 0.45) & (offset.min(axis=1) < 0.2)
    thin = scene.extents[cover.pieces][:, PLAN].max(axis=1) <= 0.35 * sides.max()
    out = cover.pieces[small & at_edge & thin]
    if not len(out):
        return None
    tab = (scene.low[out].min(axis=0) + scene.high[out].max(axis=0)) / 2.0
    return np.asarray(tab) if (np.abs(tab - cover.center)[PLAN] / sides).max() > 0.3 else None


def _hinge_side(
    scene: Scene, cover: Cover, tab: FloatArray | None
) -> tuple[tuple[int, int], tuple[str, ...]]:
    """Return axis and sign of the hinge's side: opposite the tab, else where it overhangs least."""
    if tab is not None:
        offset = (tab - cover.center)[PLAN] / (cover.high - cover.low)[PLAN]
        axis = int(np.argmax(np.abs(offset)))
        return (axis, -int(np.sign(offset[axis]))), ()
    rest = np.setdiff1d(np.arange(len(scene.low)), cover.pieces)
    body_low = scene.low[rest].min(axis=0)
    body_high = scene.high[rest].max(axis=0)
    long_axis = FRONT if scene.size[SIDEWAYS] >= 0.95 * scene.size[FRONT] else SIDEWAYS
    ahead = body_low[long_axis] - cover.low[long_axis]
    back = cover.high[long_axis] - body_high[long_axis]
    if abs(ahead - back) > scene.touch / 2:
        return (long_axis, 1 if ahead > back else -1), (
            "has no grip; hinged where it sticks out least",
        )
    return (long_axis, 1), ("has no grip; its hinge is assumed at the back",)


def _hinged(
    scene: Scene, cover: Cover, side: tuple[int, int], kind: PartKind, guess: tuple[str, ...]
) -> tuple[Mover, ...]:
    across, sign = side
    origin = cover.center
    origin[across] = cover.high[across] if sign > 0 else cover.low[across]
    origin[UP] = cover.low[UP]
    axis = np.zeros(3)
    axis[SIDEWAYS if across == FRONT else FRONT] = -sign if across == FRONT else sign
    points, owner = surface_points(scene)
    margin = np.minimum(scene.touch, 0.2 * (cover.high - cover.low))
    rest = points[~np.isin(owner, cover.pieces)]
    turn = free_turn(
        rest, np.stack([cover.low + margin, cover.high - margin]), axis, origin, LIMITS[kind]
    )
    if turn < LEAST_TURN:
        return ()
    weight = float(np.prod((cover.high - cover.low)[PLAN]))
    motion = Motion(JointKind.REVOLUTE, axis, origin, 0.0, turn)
    return (Mover(kind, motion, cover.pieces, guess, weight),)


def _screen(scene: Scene, slab: int) -> tuple[Mover, ...]:
    """Find a closed laptop: two flat slabs with many small keys between, near the hinge."""
    width, depth, _ = scene.extents.T
    plan = width * depth
    twins = np.flatnonzero(plan >= 0.75 * plan[slab])
    under = [int(k) for k in twins if scene.high[k, UP] <= scene.low[slab, UP] + scene.touch]
    if not under:
        return ()
    base = min(under, key=lambda k: (float(scene.low[k, UP]), k))
    middle = (scene.low + scene.high) / 2.0
    keys = (plan <= 0.01 * plan[slab]) & (middle[:, UP] < scene.low[slab, UP] + scene.touch)
    keys &= scene.high[:, UP] > scene.high[base, UP]
    if keys.sum() < LEAST_KEYS:
        return ()
    across = FRONT if scene.size[SIDEWAYS] >= scene.size[FRONT] else SIDEWAYS
    sign = 1 if middle[keys, across].mean() >= middle[slab, across] else -1
    group = np.flatnonzero(scene.low[:, UP] >= scene.low[slab, UP] - scene.touch / 4)
    group = np.union1d(group, np.setdiff1d(twins, [base]))
    edge = scene.high[slab, across] if sign > 0 else scene.low[slab, across]
    barrels = np.setdiff1d(np.flatnonzero((middle[:, across] - edge) * sign > 0), group)
    leaves = barrels[middle[barrels, UP] >= scene.low[slab, UP]]
    moving = [k for k in barrels if any(_touch(scene, int(k), int(leaf)) for leaf in leaves)]
    group = np.union1d(group, np.array(moving, dtype=np.int64))
    cover = Cover(scene.low[slab], scene.high[slab], np.union1d(group, barrels))
    return tuple(
        replace(mover, pieces=group, motion=_at_barrels(mover.motion, middle[barrels], across))
        for mover in _hinged(scene, cover, (across, sign), PartKind.SCREEN, ())
    )


def _touch(scene: Scene, a: int, b: int) -> bool:
    gap = np.maximum(scene.low[a] - scene.high[b], scene.low[b] - scene.high[a])
    return bool((gap <= scene.touch).all())


def _at_barrels(motion: Motion, barrels: FloatArray, across: int) -> Motion:
    """Return the hinge in the middle of its barrels, if there are some."""
    moved = motion.origin.copy()
    if len(barrels):
        moved[[across, UP]] = barrels[:, [across, UP]].mean(axis=0)
    return replace(motion, origin=moved)
