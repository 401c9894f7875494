"""Whether a joint turns its part as people hang doors, knobs and lids, or slides it straight."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...articulation import Joint
from ...asset import Hull
from ...config import SeparateConfig
from ...mesh import FloatArray
from ..decompose.outside import outside
from ..hinges import CROOKED, is_askew
from ..poses import arms_from
from .budget import SeenSurface
from .clip import clipped

#: Around an axis a seat is looked at in so many directions.
SEAT_SECTORS = 8
#: What turns about its middle, or in its seat, reaches from the axis at least this share of its
#: farthest the other way, or in each direction: the axis is off the middle by a third of the radius
#: at most.
MIDDLE_SHARE = 0.5
#: What lies no further ahead than this is touched [m].
MET_M = 0.003


def well_hung(
    surface: SeenSurface, joint: Joint, holder: Sequence[Hull], config: SeparateConfig
) -> bool:
    """Tell whether a joint runs straight, and turns its part about an edge, its middle or its seat.

    A carrier's surface has no points; ``holder`` are the hulls that hold the part.
    """
    if is_askew(joint.axis, CROOKED):
        return False
    if not joint.turns or not len(surface.points):
        return True
    ahead, behind = _reach(arms_from(joint, surface.points))
    if at_an_edge(surface, joint, config) or behind >= MIDDLE_SHARE * ahead:
        return True
    return seat_roundness(surface, joint, holder, config.clearance_m) > MIDDLE_SHARE


def at_an_edge(surface: SeenSurface, joint: Joint, config: SeparateConfig) -> bool:
    """Tell whether a part reaches to its axis, and no further beyond it than may be cut back."""
    if not len(surface.points):
        return False
    arms = arms_from(joint, surface.points)
    near = max(float(np.linalg.norm(arms, axis=1).min()), _reach(arms)[1])
    return near <= trimmed_limit(config, surface.diagonal)


def seat_roundness(
    surface: SeenSurface, joint: Joint, holder: Sequence[Hull], near_m: float
) -> float:
    """Return how near its axis a part touches what holds it on its worst side, over the farthest.

    1: it turns in a round seat. A lever whose arm stands out to one side of a collar has one; a
    door has none, however it is hung, nor a lever whose axis lies beside the collar: 0.
    """
    arms = arms_from(joint, surface.points)[outside(holder, surface.points) <= near_m]
    across = arms @ np.linalg.svd(joint.axis[None])[2][1:].T
    turned = np.arctan2(across[:, 1], across[:, 0]) / (2.0 * np.pi)
    sector = np.round(SEAT_SECTORS * turned).astype(int) % SEAT_SECTORS
    reach = np.zeros(SEAT_SECTORS)
    np.maximum.at(reach, sector, np.linalg.norm(across, axis=1))
    return float(reach.min() / max(float(reach.max()), 1e-9))


def trimmed_limit(config: SeparateConfig, diagonal: float) -> float:
    """Return how much may be cut back of a part of this diagonal [m], in [m]."""
    return max(config.tolerance_m, min(config.planed_m, config.planed_share * diagonal))


def reach_m(surface: SeenSurface, joint: Joint) -> float:
    """Return how far a part reaches from a joint's axis [m]."""
    return float(np.linalg.norm(arms_from(joint, surface.points), axis=1).max())


def _reach(arms: FloatArray) -> tuple[float, float]:
    """Return how far points reach from an axis towards their middle, and beyond the axis [m]."""
    middle = (arms.min(axis=0) + arms.max(axis=0)) / 2.0
    along = arms @ middle / max(float(np.linalg.norm(middle)), 1e-9)
    return float(along.max()), -float(along.min())


def stands_out_m(holder: Sequence[Hull], mover: Sequence[Hull], joint: Joint) -> float:
    """Return how much further than its own travel a slide stands out of what it goes into [m].

    Infinite where it goes into nothing. Negative for other parts: those would go in deeper than
    they stand out, as a drawer that runs the wrong way does, or meet something further on.
    """
    points = np.concatenate([hull.vertices for hull in mover])
    ways = [(joint.upper, joint.axis), (-joint.lower, -joint.axis)]
    ways = [(travel, axis) for travel, axis in ways if travel > 0.0]
    spare = (_spare(points @ axis, _before(holder, points, axis), way) for way, axis in ways)
    return min(spare, default=np.inf)


def _spare(heights: FloatArray, before: list[tuple[float, float]], travel: float) -> float:
    """Return the same along one direction, in which the mover goes as far as it travels [m].

    Its points have some heights, and hulls of the holder lie in its shadow between others [m].
    """
    first = float(heights.min())
    lead = float(heights.max())
    end = lead
    begins = np.inf
    for low, high in sorted(before):
        if low > end + MET_M:
            # A gap: what lies behind it is out of reach, or run into.
            if low < lead + travel:
                return -travel
            break
        begins = min(begins, low)
        end = max(end, high)
    return begins - first - travel if end > lead else np.inf


def _before(
    holder: Sequence[Hull], points: FloatArray, direction: FloatArray
) -> list[tuple[float, float]]:
    """Return from where to where along a direction hulls lie in the shadow of points [m]."""
    across = np.linalg.svd(direction[None])[2][1:]
    found = []
    for hull in holder:
        left: Hull | None = hull
        for side in (*across, *-across):
            left = left and clipped(left, side, float((points @ side).max()))
        if left is not None:
            heights = left.vertices @ direction
            found.append((float(heights.min()), float(heights.max())))
    return found
