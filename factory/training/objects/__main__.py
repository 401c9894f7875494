"""Write a sample of training's kind with its ground truth.

python -m asset_factory.factory.training.objects FOLDER --category oven --seed 3 --character artist --open 0.5
"""

from __future__ import annotations

import argparse
from pathlib import Path

from ...articulation import Articulation, JointKind
from .catalog import CATEGORIES, make_object
from .mixture import in_character
from .sample_files import write_sample


def opening(articulation: Articulation, share: float) -> dict[str, float]:
    """Joint values at this share of every joint's way from closed; joints without ends turn by that share of pi."""
    return {
        joint.name: share * joint.upper
        if joint.kind is JointKind.CONTINUOUS
        else joint.lower + share * (joint.upper - joint.lower)
        for joint in articulation.movable_joints
    }


def main() -> None:
    """Parse, make, write."""
    parser = argparse.ArgumentParser(
        prog="python -m asset_factory.factory.training.objects", description=__doc__
    )
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.add_argument("folder", type=Path, help="where to write")
    parser.add_argument("--category", choices=CATEGORIES, required=True, help="kind of the object")
    parser.add_argument("--seed", type=int, default=0, help="of the object and of its character")
    parser.add_argument(
        "--character",
        choices=("plain", "artist", "generated"),
        default="artist",
        help="its surface",
    )
    parser.add_argument(
        "--open", type=float, default=0.0, metavar="SHARE", help="0 closed to 1 open"
    )
    given = parser.parse_args()
    if not 0.0 <= given.open <= 1.0:
        parser.error(f"--open is {given.open}, want 0 to 1")
    if given.seed < 0:
        parser.error(f"--seed is {given.seed}, want at least 0")
    articulation, _ = in_character(
        make_object(given.category, given.seed), given.character, given.seed
    )
    write_sample(articulation, given.folder, opening(articulation, given.open))


if __name__ == "__main__":
    main()
