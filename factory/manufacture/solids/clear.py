"""The last cut: pieces of parts that move against one another are kept apart on all of their way."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...articulation import Articulation
from ...asset import Hull
from ..separate.separate import cut_apart_along
from .work import Work

#: Between the pieces of two parts, at rest and on the way [m].
CLEARANCE_M = 0.0025
POSES = 25
#: Parts that would lose more are in each other's way: their pieces are left for the judge to see.
LEAST_LEFT = 0.5


def cleared(work: Work) -> dict[int, tuple[Hull, ...]]:
    """Pieces per part, cut where a part would come nearer to another than it may."""
    hulls = {part: list(work.hulls.get(part, ())) for part in range(len(work.source.parts))}
    articulation = replace(work.source, joints=tuple(work.joints))
    for a, b in _pairs(articulation):
        if not (hulls[a] and hulls[b]):
            continue
        before = hulls[a], hulls[b]
        after = cut_apart_along(articulation, (a, b), before, POSES, CLEARANCE_M)
        if all(
            _volume(new) > LEAST_LEFT * _volume(old) for old, new in zip(before, after, strict=True)
        ):
            hulls[a], hulls[b] = after
    return {part: tuple(_bodies(kept)) for part, kept in hulls.items()}


def _volume(hulls: list[Hull]) -> float:
    return sum(hull.volume for hull in hulls)


def _pairs(articulation: Articulation) -> list[tuple[int, int]]:
    count = len(articulation.parts)
    return [(a, b) for a in range(count) for b in range(a + 1, count)]


def _bodies(hulls: list[Hull]) -> list[Hull]:
    """Without slivers, unless there is nothing else."""
    thick = [hull for hull in hulls if np.ptp(hull.vertices, axis=0).min() > 0.001]
    return thick or hulls
