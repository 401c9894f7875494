"""The kinds of object there are."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...articulation import Articulation
from .appliances import dishwasher, fridge, microwave, oven
from .furniture import cabinet, chest
from .small import laptop, trash_can

_MAKERS: dict[str, Callable[[np.random.Generator], Articulation]] = {
    "cabinet": cabinet,
    "fridge": fridge,
    "oven": oven,
    "microwave": microwave,
    "dishwasher": dishwasher,
    "laptop": laptop,
    "chest": chest,
    "trash_can": trash_can,
}

CATEGORIES: tuple[str, ...] = tuple(_MAKERS)


def make_object(category: str, seed: int) -> Articulation:
    """An object with exact ground truth.

    Metres, z up, standing on z = 0, centred, its front towards -Y, everything closed. Each part is
    several closed convex solids, as an artist would model it; parts never interpenetrate, at rest or
    anywhere along a joint's range.

    Args:
        category: one of :data:`CATEGORIES`.
        seed: same category and seed, same object; any integer of at least 0.

    Returns:
        The articulation; every joint's ``lower`` is 0 and closed.

    Raises:
        ValueError: no such category, or a negative seed.
    """
    if category not in _MAKERS:
        raise ValueError(f"category {category!r}: there is none of that name, want one of {', '.join(CATEGORIES)}")
    if seed < 0:
        raise ValueError(f"seed is {seed}, want at least 0")
    return _MAKERS[category](np.random.default_rng([CATEGORIES.index(category), seed]))
