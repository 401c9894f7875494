"""Which overlaps belong to a hinge's own knuckle, and which are faults that lie near it.

A knuckle is short: two leaves share an axle somewhere along the hinge. A panel that overlaps its
frame along the whole hinge side is none, however near the axis that lies; nor is one whose edge
turns into the frame, because there nothing overlaps at rest.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..config import PenetrationConfig
from ..description import FloatArray
from ..geometry.depth import contact_region
from ..geometry.path import JointAxis
from ..geometry.solids import HullPair, Solids


def knuckles(
    solids: Solids,
    overlaps: Sequence[HullPair],
    line: JointAxis,
    moving: int,
    config: PenetrationConfig,
) -> frozenset[HullPair]:
    """Return the pairs of solids whose overlap at rest is this hinge's knuckle.

    Solids are placed at rest; those that overlap are all of the two parts that the hinge joins.
    """
    inside: dict[HullPair, FloatArray] = {}
    for pair in overlaps:
        one, other = (solids.items[index].collider.hull for index in pair)
        region = contact_region(one, other)
        if len(region) and within(region, line, config.hinge_radius_m):
            inside[pair] = region
    if not inside:
        return frozenset()
    turning = solids.points(np.flatnonzero(solids.parts == moving).tolist())
    length = float(np.ptp(turning @ line.axis))
    heights = [region @ line.axis for region in inside.values()]
    taken = _covered([(float(each.min()), float(each.max())) for each in heights])
    return frozenset(inside) if taken <= config.hinge_share * length else frozenset()


def within(region: FloatArray, line: JointAxis, radius: float) -> bool:
    """Return whether every point lies within ``radius`` [m] of the line."""
    return bool(np.linalg.norm(line.arms(region), axis=1).max() <= radius)


def _covered(spans: list[tuple[float, float]]) -> float:
    """Return the length of the union of intervals."""
    total = 0.0
    reached = -np.inf
    for low, high in sorted(spans):
        total += max(0.0, high - max(low, reached))
        reached = max(reached, high)
    return total
