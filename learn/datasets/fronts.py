"""Where a dataset's doors and drawers open to, so a wrong ``front`` is seen before training."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from ..samples.sampled_object import SampledObject, read_sampled
from .settings import FRONTS

#: Horizontal ways, as settings call them.
WAYS = {"x": (1.0, 0.0), "y": (0.0, 1.0), "-x": (-1.0, 0.0), "-y": (0.0, -1.0)}
#: Smaller movements of a part, as a share of its object's size, are those of buttons and switches.
LEAST = 0.05
#: How far a hinge is opened to see which way it goes [rad].
AJAR = 0.5


def opening_way(sampled: SampledObject) -> str | None:
    """Return the horizontal way most surface moves as parts open; ``None`` if hardly any does."""
    size = float(np.ptp(sampled.points, axis=0).max())
    total = np.zeros(2)
    for part in range(1, len(sampled.parents)):
        points = sampled.points[sampled.part_ids == part]
        if not len(points):
            continue
        center = (points.min(axis=0) + points.max(axis=0)) / 2.0
        angle = 0.0 if sampled.endless[part] else min(float(sampled.turn[part, 1]), AJAR)
        moved = np.cross(sampled.axis[part], center - sampled.origin[part]) * angle
        moved = moved + sampled.slide_direction[part] * sampled.slide[part, 1]
        if np.linalg.norm(moved[:2]) > LEAST * size:
            total += moved[:2] * np.linalg.norm(points.max(axis=0) - points.min(axis=0))
    if np.linalg.norm(total) <= LEAST * size * size:
        return None
    return max(WAYS, key=lambda way: float(total @ np.asarray(WAYS[way])))


def front_advice(paths: Iterable[Path], front: str) -> str:
    """Return a sentence on which way sampled objects open that were made with ``front``."""
    seen = (opening_way(read_sampled(path)) for path in paths)
    ways = Counter(way for way in seen if way is not None)
    if not ways:
        return "no door or drawer opens sideways: the front cannot be told"
    way, count = ways.most_common(1)[0]
    said = f"{count} of {ways.total()} with doors or drawers open towards {way}"
    if count <= ways.total() / 2:
        return f"{said}: they look all ways"
    if way == "-y":
        return f"{said}, as they should"
    quarters = (FRONTS[way] + FRONTS[front]) % 4
    better = next(name for name, turns in FRONTS.items() if turns % 4 == quarters)
    return f"{said}, want -y: try --front {better}"
