"""Learn what panels look like and how they open, from pictures of generated objects.

The picture network, for ``configs/weights/seams.npz``, takes an hour or two on one core; the
judges of rectangles, for ``configs/seams.toml``, some minutes more than the pictures:

    python -m asset_factory.learn.elevations see seams.npz --kept views/ --rounds 20
    python -m asset_factory.learn.elevations judge seams.toml --kept rows/
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from asset_factory.factory.articulation import Articulation
from asset_factory.factory.errors import InputRejected
from asset_factory.factory.geometry.posing import closed, turned
from asset_factory.factory.runtime.terminal import say

from ..datasets.description import find_descriptions, read_description
from ..datasets.settings import SourceSettings
from ..objects import CATEGORIES, make_object
from .fitting import fit, report
from .rows import Rows, rows_of
from .table import table_of
from .views import views_of, write_views

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
#: Objects of a folder are looked at so often, each time in other looks.
LOOKS = 3


def main() -> None:
    """Parse, then do what was asked."""
    parser = argparse.ArgumentParser(
        prog="python -m asset_factory.learn.elevations",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    commands = parser.add_subparsers(required=True)
    see = commands.add_parser("see", help="the picture network")
    see.set_defaults(run=_see)
    see.add_argument("--rounds", type=int, default=20, help="of training")
    see.add_argument("--described", type=Path, help="folder with objects to learn from as well")
    see.add_argument(
        "--turn", type=float, default=-90.0, help="that brings their fronts to -Y [deg]"
    )
    judge = commands.add_parser("judge", help="of panels and of how they open")
    judge.set_defaults(run=_judge)
    for command, objects in ((see, 3000), (judge, 1200)):
        command.add_argument("output", type=Path, help="file to write")
        command.add_argument("--objects", type=int, default=objects, help="generated to learn from")
        command.add_argument("--kept", type=Path, required=True, help="where pictures are kept")
        command.add_argument("--seed", type=int, default=0, help="of objects, looks and weights")
    options = parser.parse_args()
    options.kept.mkdir(parents=True, exist_ok=True)
    options.run(options)


def _see(options: argparse.Namespace) -> None:
    from .seeing import learn_to_see

    for number in range(options.objects):
        path = options.kept / f"{options.seed}_{number}.npz"
        if not path.is_file():
            rng = np.random.default_rng([options.seed, number])
            write_views(path, views_of(_made(number, rng), rng))
    if options.described is not None:
        for name, articulation in _described(options.described, options.turn):
            for look in range(LOOKS):
                rng = np.random.default_rng([options.seed, look, len(articulation.mesh.faces)])
                path = options.kept / f"{name.replace('/', '__')}_{look}.npz"
                if not path.is_file():
                    write_views(path, views_of(articulation, rng))
    state = options.kept / "state.pt"
    learn_to_see(options.kept, state, options.output, options.rounds, options.seed)


def _described(folder: Path, degrees: float) -> Iterator[tuple[str, Articulation]]:
    for item in find_descriptions(folder):
        try:
            whole = closed(read_description(item, SourceSettings()))
        except InputRejected as error:
            say(f"{item.name} left out: {error}")
            continue
        yield item.name, turned(whole, float(np.radians(degrees)))


def _judge(options: argparse.Namespace) -> None:
    rows = [_kept(options.kept, options.seed, number) for number in range(options.objects)]
    judges = fit(rows, options.seed)
    options.output.write_text(table_of(judges, options.objects), encoding="utf-8")
    say(report(rows, options.seed))


def _kept(folder: Path, seed: int, number: int) -> Rows:
    path = folder / f"{seed}_{number}.npz"
    if not path.is_file():
        rng = np.random.default_rng([seed, number])
        np.savez_compressed(path, **vars(rows_of(_made(number, rng), rng)))
    with np.load(path, allow_pickle=False) as data:
        return Rows(**{name: data[name] for name in data.files})


def _made(number: int, rng: np.random.Generator) -> Articulation:
    kinds = (PANELLED, LIDDED, PANELLED, OTHER, PANELLED)[number % 5]
    kind = str(rng.choice(CATEGORIES if number % 10 == 3 else kinds))
    return make_object(kind, int(rng.integers(2**31)))


if __name__ == "__main__":
    main()
