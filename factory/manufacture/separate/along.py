"""The hulls of two parts cut apart along the whole way that they move against one another."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...asset import Hull
from ...mesh import FloatArray
from .carve import carved
from .clip import PlanedHull, cut_apart, meeting

#: For each piece more a cut must lose less, by this share.
PIECE_SHARE = 0.25

Sides = tuple[list[PlanedHull], list[PlanedHull]]


def cut_apart_along(
    a: Sequence[Hull], b: Sequence[Hull], poses: Sequence[FloatArray], clearance_m: float
) -> tuple[list[Hull], list[Hull]]:
    """Both lists with every pair of hulls cut to the clearance at every pose.

    Args:
        a: hulls of one part, object frame at rest.
        b: hulls of another.
        poses: where the second part is as seen from the first, [4, 4] each.
        clearance_m: to be left between them [m].
    """
    solids_a: list[PlanedHull | None] = [PlanedHull.of(hull) for hull in a]
    solids_b: list[PlanedHull | None] = [PlanedHull.of(hull) for hull in b]
    # Pose by pose: what meets first is cut first, a little at a time.
    for pose in poses:
        for i, j in near_pairs(solids_a, solids_b, pose, clearance_m):
            solids_a[i], solids_b[j] = _planed(solids_a[i], solids_b[j], [pose], clearance_m)
    return [solid.hull for solid in solids_a if solid], [solid.hull for solid in solids_b if solid]


def carved_apart_along(
    a: Sequence[Hull],
    b: Sequence[Hull],
    poses: Sequence[FloatArray],
    clearance_m: float,
    whole: tuple[float, float] = (1.0, 1.0),
) -> tuple[list[Hull], list[Hull]]:
    """The same, but a hull may become several around what another takes of it.

    Args:
        a: hulls of one part, object frame at rest.
        b: hulls of another.
        poses: where the second part is as seen from the first, [4, 4] each.
        clearance_m: to be left between them [m].
        whole: what a cut takes of each part is weighed against this [m3].
    """
    pieces_a = [[PlanedHull.of(hull)] for hull in a]
    pieces_b = [[PlanedHull.of(hull)] for hull in b]
    when: dict[tuple[int, int], list[FloatArray]] = {}
    for pose in poses:
        for pair in near_pairs(
            [p[0] for p in pieces_a], [p[0] for p in pieces_b], pose, clearance_m
        ):
            when.setdefault(pair, []).append(pose)
    for (i, j), way in sorted(when.items(), key=lambda found: found[0]):
        pieces_a[i], pieces_b[j] = _all_apart(pieces_a[i], pieces_b[j], way, clearance_m, whole)
    return [solid.hull for solids in pieces_a for solid in solids], [
        solid.hull for solids in pieces_b for solid in solids
    ]


def hull_depth(
    a: Sequence[Hull], b: Sequence[Hull], pose: FloatArray, margin: float = 0.0
) -> float:
    """How deep the deepest two hulls of two parts lie in one another [m].

    Gaps up to ``margin`` are negative depths; where all hulls are further apart, minus that.
    """
    solids_a = [PlanedHull.of(hull) for hull in a]
    solids_b = [PlanedHull.of(hull) for hull in b]
    near = near_pairs(solids_a, solids_b, pose, margin)
    return max([-margin, *(meeting(solids_a[i], solids_b[j], pose).depth for i, j in near)])


def _all_apart(
    ones: list[PlanedHull],
    others: list[PlanedHull],
    way: list[FloatArray],
    clearance_m: float,
    whole: tuple[float, float],
) -> Sides:
    """The pieces of one hull cut apart from those of another."""
    i = 0
    while i < len(ones):
        j = 0
        while j < len(others):
            # What is apart stays so however it is cut, so nothing is looked at twice for long.
            first, second = _apart(ones[i], others[j], way, clearance_m, whole)
            ones[i : i + 1] = first
            others[j : j + 1] = second
            if not first:
                break
            j += len(second)
        else:
            i += 1
    return ones, others


def _apart(
    one: PlanedHull,
    other: PlanedHull,
    way: list[FloatArray],
    clearance_m: float,
    whole: tuple[float, float],
) -> Sides:
    """Two hulls in as few pieces as it takes: both cut by planes, pose by pose, or one carved."""
    depths = [meeting(one, other, pose).depth for pose in way]
    met = [pose for pose, depth in zip(way, depths, strict=True) if depth > -clearance_m]
    if not met:
        return [one], [other]
    first, second = _planed(one, other, met, clearance_m)
    planed = [first] if first else [], [second] if second else []
    if max(depths) <= clearance_m:
        return planed
    # All the room that either takes as the other sees it.
    ahead = np.hstack([pose[:3, :3] @ other.hull.vertices.T + pose[:3, 3:] for pose in met]).T
    back = np.hstack([pose[:3, :3].T @ (one.hull.vertices.T - pose[:3, 3:]) for pose in met]).T
    ways: tuple[Sides, ...] = (
        planed,
        (carved(one, ahead, clearance_m), [other]),
        ([one], carved(other, back, clearance_m)),
    )
    return min(ways, key=lambda sides: _cost(sides, (one, other), whole))


def _planed(
    one: PlanedHull | None, other: PlanedHull | None, way: list[FloatArray], clearance_m: float
) -> tuple[PlanedHull | None, PlanedHull | None]:
    for pose in way:
        if one is None or other is None:
            break
        met = meeting(one, other, pose)
        if met.depth > -clearance_m:
            one, other = cut_apart(one, other, pose, met, clearance_m)
    return one, other


def _cost(sides: Sides, before: tuple[PlanedHull, PlanedHull], whole: tuple[float, float]) -> float:
    """Share of what is whole that is lost, more pieces counted in."""
    lost = 0.0
    for pieces, hull, of in zip(sides, before, whole, strict=True):
        lost += (hull.hull.volume - sum(piece.hull.volume for piece in pieces)) / of
    extra = sum(max(0, len(pieces) - 1) for pieces in sides)
    return lost * (1.0 + PIECE_SHARE * extra)


def near_pairs(
    a: Sequence[PlanedHull | None],
    b: Sequence[PlanedHull | None],
    pose: FloatArray,
    margin: float,
) -> list[tuple[int, int]]:
    """Indices of hulls whose boxes come within ``margin`` [m] of one another."""
    low_a, high_a = _boxes(a, np.eye(4))
    low_b, high_b = _boxes(b, pose)
    apart = (low_a[:, None] > high_b[None] + margin) | (high_a[:, None] < low_b[None] - margin)
    return [(int(i), int(j)) for i, j in np.argwhere(~apart.any(axis=2))]


def _boxes(solids: Sequence[PlanedHull | None], pose: FloatArray) -> tuple[FloatArray, FloatArray]:
    low = np.full((len(solids), 3), np.inf)
    high = np.full((len(solids), 3), -np.inf)
    for number, solid in enumerate(solids):
        if solid is not None:
            points = solid.hull.vertices @ pose[:3, :3].T + pose[:3, 3]
            low[number] = points.min(axis=0)
            high[number] = points.max(axis=0)
    return low, high
