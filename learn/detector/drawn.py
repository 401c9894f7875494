"""Which generated objects the detector learns from."""

from __future__ import annotations

import numpy as np

from asset_factory.factory.articulation import Articulation, JointKind

from ..objects import CATEGORIES, make_object
from ..surfaces import skin_like
from .sides import LabelledSides, labelled_sides
from .still import STILL, make_still

#: Kinds with panels, with lids, and with neither.
PANELLED = (
    "cabinet", "fridge", "oven", "microwave", "dishwasher", "dresser", "nightstand", "wardrobe",
    "sideboard", "base_cabinet", "sink_cabinet", "tall_cabinet", "wall_cabinet", "media_unit",
    "filing_cabinet", "shoe_cabinet", "lockers", "storage_unit", "washstand", "refrigerator",
    "mini_fridge", "wine_cooler", "stove", "built_in_oven", "microwave_oven", "dish_washer",
    "front_loader", "desk", "vanity", "safe", "kitchen", "oven_tower", "secretaire", "hutch",
)  # fmt: skip
LIDDED = (
    "chest", "coffer", "case", "flap_box", "trash_can", "wheelie_bin", "step_bin", "top_loader",
    "tool_chest", "pot", "glass_freezer", "toilet", "mailbox",
)  # fmt: skip
OTHER = (
    "office_chair", "bookcase", "table", "clock", "monitor", "fan", "desk_lamp", "cart", "camera",
    "bottle", "valve", "door", "printer", "stapler", "switch_panel", "hood",
)  # fmt: skip
#: Shares of objects with panels, with lids, that stay still, others that move; else of any kind.
SHARES = (0.5, 0.2, 0.17, 0.06)
#: Share of objects some of whose parts stand open.
OPENED = 0.12


def drawn_one_piece(rng: np.random.Generator) -> tuple[str, LabelledSides]:
    """Return a generated object's kind and its sides, made one piece as image-to-3D gives it."""
    while True:
        kind, made, _ = _drawn(rng)
        try:
            return kind, labelled_sides(skin_like(made, int(rng.integers(2**31))))
        except ValueError:
            # Something that the rest hangs on lies within: another object is drawn.
            continue


def drawn_sides(rng: np.random.Generator) -> tuple[str, LabelledSides]:
    """Return a generated object's kind and its sides; parts may stand open."""
    kind, made, opened = _drawn(rng)
    return kind, labelled_sides(made, opened)


def _drawn(rng: np.random.Generator) -> tuple[str, Articulation, dict[str, float]]:
    """Return a generated object's kind, the object, and open joints with their share of range."""
    among = np.searchsorted(np.cumsum(SHARES), rng.random(), side="right")
    kinds = (PANELLED, LIDDED, STILL, OTHER, CATEGORIES)[among]
    kind = str(rng.choice(kinds))
    if kinds is STILL:
        return kind, make_still(kind, rng), {}
    made = make_object(kind, int(rng.integers(2**31)))
    opened = {}
    if rng.random() < OPENED:
        ended = (joint for joint in made.movable_joints if joint.kind is not JointKind.CONTINUOUS)
        names = [joint.name for joint in ended if joint.upper > 0.0]
        share = max(0.3, 1.0 / max(len(names), 1))
        opened = {name: float(rng.uniform(0.1, 1.0)) for name in names if rng.random() < share}
    return kind, made, opened
