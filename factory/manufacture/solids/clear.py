"""The last cut: pieces of parts that move against one another, kept apart on all of their way."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations

import numpy as np

from ...asset import Hull
from ...config import SeparateConfig
from ..poses import relative_poses
from ..separate.along import cut_apart_along
from .bump import APART_M
from .work import Workpiece

#: Parts that would lose more are in each other's way: their pieces are left for the judge to see.
LEAST_LEFT = 0.5


def cleared(work: Workpiece) -> dict[int, tuple[Hull, ...]]:
    """Return the pieces per part, cut where a part would come nearer to another than it may."""
    hulls = {part: list(work.hulls.get(part, ())) for part in range(len(work.source.parts))}
    articulation = replace(work.source, joints=tuple(work.joints))
    for a, b in combinations(range(len(articulation.parts)), 2):
        if not (hulls[a] and hulls[b]):
            continue
        # At rest only, where the whole way would take too much.
        for count in (SeparateConfig.poses, 1):
            before = (hulls[a], hulls[b])
            way = relative_poses(articulation, a, b, count)
            after = cut_apart_along(*before, way, APART_M)
            if all(map(_enough, before, after)):
                hulls[a], hulls[b] = after
                break
    return {part: tuple(_bodies(kept)) for part, kept in hulls.items()}


def _enough(before: list[Hull], after: list[Hull]) -> bool:
    volumes = [sum(hull.volume for hull in hulls) for hulls in (before, after)]
    return volumes[1] > LEAST_LEFT * volumes[0]


def _bodies(hulls: list[Hull]) -> list[Hull]:
    """Drop slivers, unless there is nothing else."""
    thick = [hull for hull in hulls if np.ptp(hull.vertices, axis=0).min() > 0.001]
    return thick or hulls
