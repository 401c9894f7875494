"""Where the axis of a door sits, and how far it opens without touching anything."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .chance import Chance
from .spans import Span

#: What may overlap at most [m]; half of what the objects promise.
SLACK = 0.00025


@dataclass(frozen=True)
class Swing:
    """Where a front turns.

    Attributes:
        setback: of the axis behind the face [m]; negative for one in front of it.
        trim: taken off the free edge, so that its back corner passes its neighbours [m].
    """

    setback: float
    trim: float


def swing(thickness: float, width: float, rooms: Span, taste: float) -> Swing:
    """Return a place for the axis of a front ``width`` wide [m].

    A corner at distance ``a`` across from an axis set back by ``s`` reaches ``sqrt(a^2 + b^2)``,
    ``b`` being the thickness behind the axis; in front of it the hinge edge swings out by ``s``.

    Args:
        thickness: of the front [m].
        width: from the hinge to the free edge [m].
        rooms: free beside the hinge edge and the free edge [m]; infinite where nothing is.
        taste: the wished setback in thicknesses: 0 for the front edge, 1 for the back edge.
    """
    setback = taste * thickness
    if setback > rooms[0] + SLACK:
        setback = 0.0
    trim = 0.0
    if np.isfinite(rooms[1]):
        reach = width + rooms[1] + SLACK
        behind = thickness - setback
        trim = max(0.0, width - float(np.sqrt(max(0.0, reach**2 - behind**2))))
    return Swing(setback, trim)


def stop(chance: Chance, furthest: float) -> float:
    """Return how far a door opens [rad] that could this far [degrees]; half to 90 at most."""
    draw = chance.draw(0.0, 1.0)
    degrees = min(90.0, furthest)
    if draw >= 0.5 and furthest > 90.0:
        low, high = (65.0, min(furthest, 120.0)) if draw < 0.75 else (90.0, furthest)
        degrees = chance.draw(low, high)
    return float(np.radians(round(degrees)))
