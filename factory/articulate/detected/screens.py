"""Laptops that are drawn open: where the screen begins, and how far it is turned up."""

from __future__ import annotations

import numpy as np

from ...intake.stated import Hinge, StatedKind, StatedPart
from ...mesh import Mesh
from ...views.raster import side_facing
from ..evidence.surfels import WHOLE, spread
from ..seams.fronts import OPPOSITE

#: Levels that the surface is sorted into.
LEVELS = 50
#: A level of the screen is narrower than this share of the base, along one axis.
NARROW = 0.5
#: A screen is at most so thick beside its height, and its normal points up by less than this.
THICKEST = 0.2
LYING = 0.9


def open_screen(mesh: Mesh) -> StatedPart | None:
    """Return the screen of a laptop that is drawn open, as a person would state it.

    It is the plate that stands on the base; ``None`` where there is none, as on a closed one.
    """
    points = spread(mesh.vertices[mesh.faces], WHOLE).points
    low, high = mesh.bounds
    if not high[2] > low[2]:
        return None
    shares = (points[:, 2] - low[2]) / (high[2] - low[2])
    level = np.minimum((shares * LEVELS).astype(np.int64), LEVELS - 1)
    widths = np.zeros((LEVELS, 2))
    for each in np.unique(level):
        widths[each] = np.ptp(points[level == each, :2], axis=0)
    base = widths[: LEVELS // 2].max(axis=0)
    first = int(np.flatnonzero((widths >= NARROW * base).all(axis=1)).max(initial=-1)) + 1
    screen = points[level >= first]
    if not 0 < first <= LEVELS // 2 or not len(screen):
        return None
    middle = screen.mean(axis=0)
    _, spans, axes = np.linalg.svd(screen - middle, full_matrices=False)
    if spans[2] > THICKEST * spans[1] or abs(axes[2, 2]) > LYING:
        return None
    # Up along the plate, and where it begins straight below its middle.
    up = np.array([0.0, 0.0, 1.0]) - axes[2, 2] * axes[2]
    up /= np.linalg.norm(up)
    height = float(low[2] + first / LEVELS * (high[2] - low[2]))
    foot = middle - (middle[2] - height) / up[2] * up
    side = side_facing((foot - points[level < first].mean(axis=0)) * [1.0, 1.0, 0.0])
    opened = float(np.degrees(np.arccos(up @ side.frame[2])))
    # From across, the base's top is a step in depth before the screen.
    box = (0.0, first / LEVELS, 1.0, 1.0)
    return StatedPart(StatedKind.LID, OPPOSITE[side], box, Hinge(side), drawn=opened)
