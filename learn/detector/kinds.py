"""Kinds of generated objects and of descriptions by what they are to the detector."""

from __future__ import annotations

from asset_factory.factory.models.detector.canvas import KINDS

_ALIKE: dict[str, str] = {
    name: kind
    for kind, names in {
        "cabinet": "hutch secretaire sideboard base_cabinet sink_cabinet tall_cabinet wall_cabinet "
        "media_unit display_cabinet storage_unit washstand shoe_cabinet vanity",
        "drawer_unit": "dresser nightstand filing_cabinet tool_chest drawer",
        "fridge": "refrigerator mini_fridge wine_cooler glass_freezer",
        "oven": "stove built_in_oven oven_tower hob hood",
        "microwave": "microwave_oven",
        "dishwasher": "dish_washer",
        "washer": "front_loader top_loader",
        "chest": "coffer",
        "case": "trolley_case",
        "bin": "trash_can swing_bin step_bin wheelie_bin push_bin bucket trash",
        "door": "sliding_door",
        "table": "folding_table still_table",
        "shelf": "bookcase still_shelf",
        "bed": "storage_bed still_bed",
        "chair": "office_chair folding_chair still_chair",
        "sofa": "still_sofa",
        "laptop": "notebook",
        "screen": "monitor still_screen",
        "lamp": "desk_lamp standing_lamp",
        "plant": "still_pot",
        "box": "flap_box",
        "crate": "still_crate",
        "barrel": "still_barrel",
        "still": "still_heap",
    }.items()
    for name in names.split()
}


def kind_number(name: str) -> int:
    """Return the number of a kind by a generated object's or a description's word for it."""
    kind = _ALIKE.get(name, name)
    return KINDS.index(kind if kind in KINDS else "gadget")
