"""The kinds of object there are."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Mapping

import numpy as np

from ...articulation import Articulation
from . import (
    appliances,
    bins,
    boxes,
    carts,
    chairs,
    coffee,
    cooking,
    cooling,
    eyewear,
    fans,
    furniture,
    gadgets,
    hand_tools,
    kitchens,
    lamps,
    laundry,
    lidded,
    notebooks,
    openings,
    seats,
    small,
    stationery,
    storage,
    switches,
    tables,
    taps,
    two_tier,
    vessels,
)

#: Makes one object of a kind from a random generator.
Maker = Callable[[np.random.Generator], Articulation]

#: One entry per file of objects; a file's ``MAKERS`` names what it makes.
_FILES: tuple[Mapping[str, Maker], ...] = (
    furniture.MAKERS,
    appliances.MAKERS,
    small.MAKERS,
    storage.MAKERS,
    cooling.MAKERS,
    cooking.MAKERS,
    laundry.MAKERS,
    openings.MAKERS,
    tables.MAKERS,
    lidded.MAKERS,
    kitchens.MAKERS,
    two_tier.MAKERS,
    bins.MAKERS,
    boxes.MAKERS,
    carts.MAKERS,
    chairs.MAKERS,
    coffee.MAKERS,
    eyewear.MAKERS,
    fans.MAKERS,
    gadgets.MAKERS,
    hand_tools.MAKERS,
    lamps.MAKERS,
    notebooks.MAKERS,
    seats.MAKERS,
    switches.MAKERS,
    taps.MAKERS,
    vessels.MAKERS,
    stationery.MAKERS,
)

#: What the demo meshes are made of; seeded by place, so that they stay the bytes they are.
DEMO_CATEGORIES: tuple[str, ...] = (
    "cabinet",
    "fridge",
    "oven",
    "microwave",
    "dishwasher",
    "laptop",
    "chest",
    "trash_can",
)

_MAKERS: dict[str, Maker] = {name: maker for makers in _FILES for name, maker in makers.items()}

CATEGORIES: tuple[str, ...] = (
    *DEMO_CATEGORIES,
    *(name for name in _MAKERS if name not in DEMO_CATEGORIES),
)


def make_object(category: str, seed: int) -> Articulation:
    """An object with exact ground truth.

    Metres, z up, standing on z = 0, centred, its front towards -Y, everything closed. Each part is
    several closed solids, as an artist would model it (convex ones for the demo). Parts never
    interpenetrate by more than half a millimetre, at rest or anywhere along one joint's range while
    the others are closed; parts named ``inner_...`` lie behind a door and move while the doors are
    open.

    Args:
        category: one of :data:`CATEGORIES`.
        seed: same category and seed, same object; any integer of at least 0.

    Returns:
        The articulation; every joint's ``lower`` is 0 and closed.

    Raises:
        ValueError: no such category, or a negative seed.
    """
    if category not in _MAKERS:
        raise ValueError(
            f"category {category!r}: there is none of that name, want one of {', '.join(CATEGORIES)}"
        )
    if seed < 0:
        raise ValueError(f"seed is {seed}, want at least 0")
    return _MAKERS[category](np.random.default_rng([_stream(category), seed]))


def _stream(category: str) -> int:
    """Which random numbers a category draws; by name, so that a new category changes no other."""
    if category in DEMO_CATEGORIES:
        return DEMO_CATEGORIES.index(category)
    return zlib.crc32(category.encode())
