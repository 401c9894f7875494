"""Doors without a handle: slabs in front of a box, whose back edge both sides beside them show."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from ...views.raster import Side
from .edges import is_slab
from .fronts import Front
from .groups import OUTLINED, FrontPanel, Group, together
from .panels import rated
from .placing import rim_depth
from .rectangles import CLOSED, Rectangle

#: A slab takes so much of the height of what is seen.
LEAST = 0.25


def slabs_on(
    fronts: Mapping[Side, Front], side: Side, found: Sequence[Rectangle]
) -> tuple[FrontPanel, ...]:
    """Return the slabs of one side, from outline to outline.

    Args:
        fronts: the four sides.
        side: that is looked at.
        found: its rectangles closed by seams.
    """
    front = fronts[side]
    first, last, _, _ = front.relief.box
    fit = [
        group
        for group in rated(front.scene, found)
        if group.rectangle.closed >= CLOSED
        and group.rectangle.size[0] >= LEAST * (last - first)
        and is_slab(fronts, side, group.panels[0], _rim(front, group))
    ]
    return tuple(replace(group.panels[0], value=OUTLINED) for group in together(fit))


def _rim(front: Front, group: Group) -> float:
    raster = front.relief.raster
    return float(raster.near + rim_depth(front, group.panels[0]) * raster.pixel)
