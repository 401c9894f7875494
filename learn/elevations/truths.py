"""What truly opens on an object's sides: rectangles, and how they open."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from asset_factory.factory.articulate.seams.rectangles import Rectangle
from asset_factory.factory.articulation import Articulation, Joint, JointKind
from asset_factory.factory.part import OpensBy
from asset_factory.factory.views.raster import Side

from .pictures import Picture

#: A panel fills so much of its rectangle, and covers so much of what is seen of its side.
FILLED = 0.6
LEAST_AREA = 0.012
#: Pixels of a part at either end that a rectangle leaves out, as a share: hinges that stick out.
STRAY = 0.01
#: A lid covers so much of what is seen from above.
OVER = 0.5
_AROUND = (Side.FRONT, Side.RIGHT, Side.BACK, Side.LEFT)


@dataclass(frozen=True)
class TruePanel:
    """A panel that opens.

    Attributes:
        side: on which it is.
        rectangle: where.
        way: how it opens; ``None``: in a way that the articulator does not know.
    """

    side: Side
    rectangle: Rectangle
    way: OpensBy | None


def lids_of(articulation: Articulation, top: Picture) -> list[int]:
    """Return the parts that move and cover most of the view from above."""
    least = OVER * int(top.relief.seen.sum())
    moving = (joint.child for joint in articulation.movable_joints)
    return [part for part in moving if (top.part == part).sum() >= least]


def truth_of(articulation: Articulation, pictures: dict[Side, Picture]) -> tuple[TruePanel, ...]:
    """Return the panels of an object at rest; a lid is no panel."""
    lids = lids_of(articulation, pictures[Side.TOP])
    panels: list[TruePanel] = []
    for joint in articulation.movable_joints:
        if joint.child in lids:
            continue
        counts = {side: int((each.part == joint.child).sum()) for side, each in pictures.items()}
        side = max((each for each in _AROUND if each in pictures), key=lambda each: counts[each])
        panel = _panel(pictures[side], joint)
        if panel is not None:
            panels.append(panel)
    return tuple(panels)


def _panel(picture: Picture, joint: Joint) -> TruePanel | None:
    mask = picture.part == joint.child
    if mask.sum() < LEAST_AREA * picture.relief.seen.sum():
        return None
    ends = []
    for axis in (0, 1):
        share = np.cumsum(mask.sum(axis=1 - axis)) / mask.sum()
        ends.append((int(np.searchsorted(share, STRAY)), int(np.searchsorted(share, 1.0 - STRAY))))
    low = np.array([end[0] for end in ends])
    high = np.array([end[1] for end in ends]) + 1
    inside = mask[low[0] : high[0], low[1] : high[1]]
    if inside.mean() < FILLED or (high - low).min() < 6:
        return None
    rectangle = Rectangle(low, high, np.ones(4), np.ones(4))
    return TruePanel(picture.relief.side, rectangle, _way(picture, rectangle, joint))


def _way(picture: Picture, rectangle: Rectangle, joint: Joint) -> OpensBy | None:
    raster = picture.relief.raster
    right, up, away = raster.side.frame
    if joint.kind is JointKind.PRISMATIC:
        return OpensBy.OUT if float(joint.axis @ away) < -0.9 else None
    row, column, _ = raster.pixels(joint.origin)
    across = (column - rectangle.low[1]) / max(float(rectangle.size[1]), 1.0)
    height = (row - rectangle.low[0]) / max(float(rectangle.size[0]), 1.0)
    if abs(float(joint.axis @ up)) > 0.9 and not 0.3 < across < 0.7:
        return OpensBy.LEFT if across < 0.5 else OpensBy.RIGHT
    if abs(float(joint.axis @ right)) > 0.9 and not 0.3 < height < 0.7:
        return OpensBy.BOTTOM if height < 0.5 else OpensBy.TOP
    return None
