"""Where the axis of a door sits, and how far it opens without touching anything."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

#: What may overlap at most [m]; half of what the objects promise.
SLACK = 0.00025


@dataclass(frozen=True)
class Swing:
    """Where a front turns.

    Attributes:
        setback: of the axis behind the face [m]; negative for one in front of it.
        trim: taken off the free edge, so that its back corner passes what is beside it [m].
        upper: fully open [rad].
    """

    setback: float
    trim: float
    upper: float


def swing(
    rng: np.random.Generator,
    thickness: float,
    width: float,
    rooms: tuple[float, float],
    taste: float,
    furthest: float,
) -> Swing:
    """A place for the axis of a front ``width`` wide [m].

    A corner at distance ``a`` across from an axis set back by ``s`` reaches ``sqrt(a^2 + b^2)``,
    ``b`` being the thickness behind the axis; in front of the axis the hinge edge itself swings out
    by ``s``.

    Args:
        rng: draws the limit.
        thickness: of the front [m].
        width: from the hinge to the free edge [m].
        rooms: free space beside the hinge edge and beside the free edge [m]; infinite where nothing
            is.
        taste: the wished setback in thicknesses: 0 for the front edge, 1 for the back edge.
        furthest: limit of ``upper`` [degrees].
    """
    setback = taste * thickness
    if setback > rooms[0] + SLACK:
        setback = 0.0
    behind = thickness - setback
    reach = width + rooms[1] + SLACK
    trim = (
        max(0.0, width - float(np.sqrt(max(0.0, reach**2 - behind**2))))
        if np.isfinite(reach)
        else 0.0
    )
    draw = rng.random()
    if draw < 0.5 or furthest <= 90.0:
        degrees = min(90.0, furthest)
    elif draw < 0.75:
        degrees = float(rng.uniform(65.0, min(furthest, 120.0)))
    else:
        degrees = float(rng.uniform(90.0, furthest))
    return Swing(setback, trim, float(np.radians(round(degrees))))
