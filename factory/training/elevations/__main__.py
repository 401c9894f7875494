"""Learn what panels look like and how they open, for ``configs/seams.toml``.

python -m asset_factory.factory.training.elevations seams.toml --objects 1200 --rows rows/
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from ..objects import make_object
from .fitting import fit, report
from .rows import Rows, rows_of
from .table import table_of

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


def main() -> None:
    """Parse, make rows, fit, write."""
    parser = argparse.ArgumentParser(
        prog="python -m asset_factory.factory.training.elevations",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("output", type=Path, help="table to write")
    parser.add_argument("--objects", type=int, default=1200, help="how many to learn from")
    parser.add_argument("--rows", type=Path, required=True, help="where rows are kept")
    parser.add_argument("--seed", type=int, default=0, help="of objects, looks and weights")
    options = parser.parse_args()
    options.rows.mkdir(parents=True, exist_ok=True)
    rows = [_kept(options.rows, options.seed, number) for number in range(options.objects)]
    judges = fit(rows, options.seed)
    options.output.write_text(table_of(judges, options.objects), encoding="utf-8")
    print(report(rows, options.seed))


def _kept(folder: Path, seed: int, number: int) -> Rows:
    path = folder / f"{seed}_{number}.npz"
    if not path.is_file():
        made = _made(seed, number)
        np.savez_compressed(path, **vars(made))
    with np.load(path) as data:
        return Rows(**{name: data[name] for name in data.files})


def _made(seed: int, number: int) -> Rows:
    rng = np.random.default_rng([seed, number])
    kinds = (PANELLED, LIDDED, PANELLED, OTHER, PANELLED)[number % 5]
    kind = str(rng.choice(kinds))
    return rows_of(make_object(kind, int(rng.integers(2**31))), rng)


if __name__ == "__main__":
    main()
