"""Doors of appliances: the large panel beside or below a row of knobs, handle or not."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...part import OpensBy
from .candidates import usable
from .fronts import Front
from .groups import FrontPanel
from .handles import Protrusion
from .motions import Opening
from .panels import LEAST_VALUE, STRICT
from .rectangles import CLOSED, Rectangle

#: The door takes at least so much of what is seen of the side.
LEAST = 0.3
#: How likely it opens in the way that its place beside the knobs says.
LIKELY = 0.85


def appliance_door(front: Front, found: Sequence[Rectangle]) -> Opening | None:
    """Return what opens of an appliance on which nothing else was found.

    An oven's door is below its knobs and turns down, a microwave's is beside them and turns to the
    other side.

    Args:
        front: the side with the knobs.
        found: its rectangles closed by seams.
    """
    controls = [handle for handle in front.scene.face.handles if handle.control]
    seen = float(front.relief.seen.sum())
    fit = [
        each
        for each in usable(front.scene, found, STRICT)
        if each.closed >= CLOSED
        and each.area >= LEAST * seen
        and not any(each.holds(handle.center) for handle in controls)
    ]
    if not fit or not controls:
        return None
    rectangle = max(fit, key=lambda each: (round(each.closed, 1), each.area))
    way = _way(rectangle, controls)
    handles = front.scene.handles_in(rectangle)
    others = [each for each in OpensBy if each is not way]
    ways = ((way, LIKELY), *((each, (1.0 - LIKELY) / len(others)) for each in others))
    return Opening(FrontPanel(rectangle, handles, LEAST_VALUE), ways)


def _way(rectangle: Rectangle, controls: Sequence[Protrusion]) -> OpensBy:
    row, column = np.mean([handle.center for handle in controls], axis=0)
    if rectangle.low[1] <= column <= rectangle.high[1]:
        return OpensBy.BOTTOM if row > rectangle.high[0] else OpensBy.OUT
    return OpensBy.LEFT if column > rectangle.high[1] else OpensBy.RIGHT
