"""Write a sample of training's kind with its ground truth.

python -m asset_factory.learn.objects FOLDER --category oven --seed 3 --open 0.5
"""

from __future__ import annotations

import argparse
from pathlib import Path

from ..bodies import value_at
from .catalog import CATEGORIES, make_object
from .export import write_sample
from .mixture import CHARACTERS, in_character


def main() -> None:
    """Parse, make, write."""
    parser = argparse.ArgumentParser(
        prog="python -m asset_factory.learn.objects",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add = parser.add_argument
    add("folder", type=Path, help="where to write")
    add("--category", choices=CATEGORIES, required=True, help="kind of the object")
    add("--seed", type=int, default=0, help="of the object and of its character")
    add("--character", choices=CHARACTERS, default="artist", help="its surface")
    add("--open", type=float, default=0.0, metavar="SHARE", help="0 closed to 1 open")
    given = parser.parse_args()
    if not 0.0 <= given.open <= 1.0:
        parser.error(f"--open must be 0 to 1, not {given.open}")
    if given.seed < 0:
        parser.error(f"--seed must be at least 0, not {given.seed}")
    made = make_object(given.category, given.seed)
    articulation, _ = in_character(made, given.character, given.seed)
    values = {j.name: value_at(j, given.open) for j in articulation.movable_joints}
    write_sample(articulation, given.folder, values)


if __name__ == "__main__":
    main()
