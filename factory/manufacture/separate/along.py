"""The hulls of two parts cut apart along the whole way that they move against one another."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from itertools import chain

import numpy as np

from ...asset import Hull
from ...mesh import FloatArray
from ..decompose.convex import SAME_M, THINNEST_M
from ..poses import moved
from .clip import carved, cut_apart, depth_at, meeting

#: Most pieces that are kept of one hull around a pit: a floor and walls around what is round.
MOST_WALLS = 10
#: For each piece more a cut must lose less, by this share.
PIECE_SHARE = 0.25

#: A sheet that gives way may come to lie where something was before: so often all is looked at
#: again.
MOST_PASSES = 3

#: Hulls may be as near as this between two poses: PyBullet feels what is nearer [m].
LEAST_M = 0.002

Sides = tuple[list[Hull], list[Hull]]


@dataclass(frozen=True)
class Step:
    """One pose of a way.

    Attributes:
        pose: where the second part is as seen from the first, [4, 4].
        behind: from there to where it slid here from, in the first part's frame [m], shape [3].
    """

    pose: FloatArray
    behind: FloatArray


def steps_along(poses: Sequence[FloatArray]) -> list[Step]:
    """Return the poses and those between them, where a slide leads through them.

    Hulls are thinner than a step is long: a board passes a lip between two poses.
    """
    steps = []
    for number, pose in enumerate(poses):
        behind = np.zeros(3)
        near = [poses[k] for k in (number - 2, number + 1) if 0 <= k < len(poses)]
        if number and any(_even(poses[number - 1], pose, other) for other in near):
            behind = poses[number - 1][:3, 3] - pose[:3, 3]
        steps.append(Step(pose, behind))
    return steps


def _even(before: FloatArray, pose: FloatArray, other: FloatArray) -> bool:
    """Tell whether a step is as long as the one that leads to it, or on from it, and none turns."""
    if not all(np.array_equal(pose[:3, :3], each[:3, :3]) for each in (before, other)):
        return False
    step = pose[:3, 3] - before[:3, 3]
    sides = (other[:3, 3] - pose[:3, 3], before[:3, 3] - other[:3, 3])
    return min(float(np.abs(step - side).max()) for side in sides) < SAME_M


def cut_apart_along(
    a: Sequence[Hull], b: Sequence[Hull], poses: Sequence[FloatArray], clearance_m: float
) -> Sides:
    """Return both lists with every pair of hulls cut to the clearance at every pose.

    Args:
        a: hulls of one part, object frame at rest.
        b: hulls of another.
        poses: where the second part is as seen from the first, [4, 4] each.
        clearance_m: to be left between them [m].
    """
    solids_a: list[Hull | None] = list(a)
    solids_b: list[Hull | None] = list(b)
    # Pose by pose: what meets first is cut first, a little at a time.
    steps = steps_along(poses)
    for _ in range(MOST_PASSES):
        pushed = False
        for step in steps:
            for i, j in near_pairs(solids_a, solids_b, step.pose, clearance_m, step.behind):
                before = solids_a[i], solids_b[j]
                solids_a[i], solids_b[j] = _cut_by_planes(*before, [step], clearance_m)
                pushed |= any(map(_pushed, before, (solids_a[i], solids_b[j])))
        if not pushed:
            break
    return list(filter(None, solids_a)), list(filter(None, solids_b))


def carved_apart_along(
    a: Sequence[Hull],
    b: Sequence[Hull],
    poses: Sequence[FloatArray],
    clearance_m: float,
    giving: int | None = None,
) -> Sides:
    """Return the same, but a hull may become several around the room that another takes on its way.

    Arguments as of :func:`cut_apart_along`. Of each two hulls that meet the cut is made that takes
    least. Where one of the two parts is ``giving`` way, 0 or 1, it alone is cut: it gets a pit, as
    large as what turns or slides in it.
    """
    pieces_a = [[hull] for hull in a]
    pieces_b = [[hull] for hull in b]
    when: dict[tuple[int, int], list[Step]] = {}
    for step in steps_along(poses):
        for pair in near_pairs(a, b, step.pose, clearance_m, step.behind):
            when.setdefault(pair, []).append(step)
    for i, j in sorted(when):
        way = when[i, j]
        pieces_a[i], pieces_b[j] = _all_apart(pieces_a[i], pieces_b[j], way, clearance_m, giving)
    return list(chain.from_iterable(pieces_a)), list(chain.from_iterable(pieces_b))


def hull_depth(
    a: Sequence[Hull], b: Sequence[Hull], pose: FloatArray, margin: float = 0.0
) -> float:
    """Return how deep the deepest two hulls of two parts lie in one another [m].

    Gaps up to ``margin`` are negative depths; where all hulls are further apart, minus that.
    """
    near = near_pairs(a, b, pose, margin)
    return max([-margin, *(depth_at(a[i], b[j], pose) for i, j in near)])


def _all_apart(
    ones: list[Hull],
    others: list[Hull],
    way: list[Step],
    clearance_m: float,
    giving: int | None,
) -> Sides:
    """Return the pieces of one hull cut apart from those of another."""
    i = 0
    while i < len(ones):
        j = 0
        while j < len(others):
            # What is apart stays so however it is cut, so nothing is looked at twice for long.
            first, second = _apart(ones[i], others[j], way, clearance_m, giving)
            ones[i : i + 1] = first
            others[j : j + 1] = second
            if not first:
                break
            j += len(second)
        else:
            i += 1
    return ones, others


def _apart(
    one: Hull, other: Hull, way: list[Step], clearance_m: float, giving: int | None
) -> Sides:
    """Cut two hulls apart in the cheapest way: both by planes, pose by pose, or one carved."""
    depths = [meeting(one, other, step.pose, behind=step.behind).depth for step in way]
    near = THINNEST_M - clearance_m
    met = [step for step, depth in zip(way, depths, strict=True) if depth > near]
    if not met:
        return [one], [other]
    # All the room that either takes as the other sees it.
    ahead = np.concatenate([_seen(other, step.pose, step.behind) for step in met])
    back = np.concatenate([_seen(one, *_from_the_other(step)) for step in met])
    if giving == 0:
        return carved(one, ahead, clearance_m, MOST_WALLS), [other]
    if giving == 1:
        return [one], carved(other, back, clearance_m, MOST_WALLS)
    first, second = _cut_by_planes(one, other, met, clearance_m)
    by_planes = [first] if first else [], [second] if second else []
    if max(depths) <= clearance_m:
        return by_planes
    cuts: tuple[Sides, ...] = (
        by_planes,
        (carved(one, ahead, clearance_m), [other]),
        ([one], carved(other, back, clearance_m)),
    )
    return min(cuts, key=partial(_cost, one.volume + other.volume))


def _cut_by_planes(
    one: Hull | None, other: Hull | None, way: list[Step], clearance_m: float
) -> tuple[Hull | None, Hull | None]:
    for step in way:
        if one is None or other is None:
            break
        met = meeting(one, other, step.pose, behind=step.behind)
        if met.depth > -clearance_m:
            one, other = cut_apart(one, other, step.pose, met, clearance_m)
    return one, other


def _pushed(before: Hull | None, after: Hull | None) -> bool:
    """Tell whether a hull is as large as before, but elsewhere."""
    if before is None or after is None or before is after:
        return False
    return after.volume > (1.0 - 1e-6) * before.volume


def _seen(solid: Hull, pose: FloatArray, behind: FloatArray) -> FloatArray:
    """Return the corners of a moved hull, there and where it slid there from [m], shape [n, 3]."""
    points = moved(solid.vertices, pose)
    return np.concatenate([points, points + behind]) if behind.any() else points


def _from_the_other(step: Step) -> tuple[FloatArray, FloatArray]:
    """Return the same step of the first part as the second sees it."""
    back = np.asarray(np.linalg.inv(step.pose))
    return back, -back[:3, :3] @ step.behind


def _cost(before_m3: float, sides: Sides) -> float:
    """Return the volume that two hulls lost [m3], more pieces counted in."""
    left = sum(piece.volume for pieces in sides for piece in pieces)
    extra = sum(max(0, len(pieces) - 1) for pieces in sides)
    return (before_m3 - left) * (1.0 + PIECE_SHARE * extra)


def near_pairs(
    a: Sequence[Hull | None],
    b: Sequence[Hull | None],
    pose: FloatArray,
    margin: float,
    behind: FloatArray | None = None,
) -> list[tuple[int, int]]:
    """Return the indices of hulls whose boxes come within ``margin`` [m] of one another.

    ``None`` stands for a hull of which nothing is left. The second hulls are moved by ``pose``, [4,
    4]; for ``behind`` see :func:`~.clip.meeting`.
    """
    low_a, high_a = _boxes(a, np.eye(4))
    low_b, high_b = _boxes(b, pose)
    if behind is not None:
        low_b = low_b + np.minimum(behind, 0.0)
        high_b = high_b + np.maximum(behind, 0.0)
    apart = (low_a[:, None] > high_b[None] + margin) | (high_a[:, None] < low_b[None] - margin)
    return [(int(i), int(j)) for i, j in np.argwhere(~apart.any(axis=2))]


def _boxes(solids: Sequence[Hull | None], pose: FloatArray) -> tuple[FloatArray, FloatArray]:
    low = np.full((len(solids), 3), np.inf)
    high = np.full((len(solids), 3), -np.inf)
    there = [number for number, solid in enumerate(solids) if solid is not None]
    corners = [solid.vertices for solid in solids if solid is not None]
    if there:
        points = moved(np.concatenate(corners), pose)
        starts = np.cumsum([0, *map(len, corners[:-1])])
        low[there] = np.minimum.reduceat(points, starts)
        high[there] = np.maximum.reduceat(points, starts)
    return low, high
