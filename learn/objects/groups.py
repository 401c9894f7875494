"""Groups of kinds of object, by what opens on them."""

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
