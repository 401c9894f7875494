"""The kinds of object there are."""

from __future__ import annotations

import zlib
from importlib import import_module
from inspect import isfunction

import numpy as np

from asset_factory.factory.articulation import Articulation

from .kit.assembly import Assembly, Maker

#: Files of kinds, in their order in the catalog.
_FILES = (
    "storage", "white_goods", "kitchens", "openings", "tables_and_seats", "boxes", "bins", "carts",
    "kitchenware", "lamps_and_fans", "fittings", "gadgets", "hand_tools", "screens",
)  # fmt: skip

#: Kinds for demonstrations: of convex forms only, each with corners of its own.
DEMO_CATEGORIES: tuple[str, ...] = (
    "cabinet", "fridge", "oven", "microwave", "dishwasher", "laptop", "chest", "trash_can",
)  # fmt: skip
#: How far short of its place every form of the demo ends [m].
HAIRLINE_M = 5e-5


def _kinds_of(file: str) -> dict[str, Maker]:
    """Return the kinds that a file describes, by name, in its order."""
    module = vars(import_module(f"{__package__}.kinds.{file}"))
    own = [each for each in module.values() if isfunction(each) and each.__globals__ is module]
    public = {each.__name__: each for each in own if not each.__name__.startswith("_")}
    planned: dict[str, Maker] = module.get("PLANNED", {})
    return public | planned


_MAKERS = {name: maker for file in _FILES for name, maker in _kinds_of(file).items()}

CATEGORIES: tuple[str, ...] = tuple(dict.fromkeys((*DEMO_CATEGORIES, *_MAKERS)))


def make_object(category: str, seed: int) -> Articulation:
    """Return an object with exact ground truth; same category and seed, same object.

    Metres, z up, standing on z = 0, centred, its front towards -Y. Each part is several closed
    forms, as an artist would model it (convex ones for the demo). Parts never interpenetrate by
    more than half a millimetre, at rest or anywhere along one joint's range while the others are at
    rest; parts named ``inner_...`` lie behind a door and move while the doors are open. Every
    joint's ``lower`` is closed, 0 for most.

    Raises:
        ValueError: no such category, or a negative seed.
    """
    if category not in _MAKERS:
        names = ", ".join(CATEGORIES)
        raise ValueError(f"category {category!r}: there is none of that name, want one of {names}")
    if seed < 0:
        raise ValueError(f"seed must be at least 0, not {seed}")
    # By name, so that a new category changes no other.
    rng = np.random.default_rng([zlib.crc32(category.encode()), seed])
    assembly = Assembly(rng, HAIRLINE_M if category in DEMO_CATEGORIES else 0.0)
    _MAKERS[category](assembly)
    return assembly.articulation()
