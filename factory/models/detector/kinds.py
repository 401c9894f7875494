"""Kinds of object that the detector tells apart."""

KINDS = (
    "cabinet", "drawer_unit", "wardrobe", "fridge", "oven", "microwave", "dishwasher", "washer",
    "chest", "case", "bin", "door", "window", "desk", "table", "shelf", "bed", "chair", "sofa",
    "toilet", "mailbox", "safe", "lockers", "printer", "laptop", "screen", "lamp", "plant",
    "kitchen", "box", "crate", "barrel", "still", "gadget",
)  # fmt: skip
