"""Fits the evidence for motions: ``python -m asset_factory.learn.motions --help``."""

from __future__ import annotations

import argparse
import hashlib
import sys
from collections.abc import Iterator
from itertools import chain, islice
from pathlib import Path

import numpy as np

from asset_factory.factory.articulation import Articulation
from asset_factory.factory.errors import ConfigError
from asset_factory.factory.runtime.terminal import complain, say

from .fitting import fit_motions
from .motion_sample import MotionSample, motion_samples
from .objects import described, generated
from .writing import motions_text


def main(arguments: list[str] | None = None) -> int:
    """Parse, measure, fit, write; 0, or 2 where there is nothing to learn from."""
    asked = _parser().parse_args(arguments)
    objects = chain(
        generated(range(asked.first_seed, asked.first_seed + asked.seeds)),
        *(described(d) for d in asked.data),
    )
    try:
        motion_samples = list(measured(islice(objects, 0, None, asked.every)))
        text = motions_text(fit_motions(motion_samples, asked.steps))
    except ConfigError as error:
        complain(error)
        return 2
    asked.output.write_text(text)
    say(
        f"{len(motion_samples)} parts of {len({each.name for each in motion_samples})} objects; "
        f"weights in {asked.output}"
    )
    return 0


def measured(objects: Iterator[tuple[str, Articulation]]) -> Iterator[MotionSample]:
    """Yield what every object teaches; its name seeds its turn and which labels are spoilt."""
    for name, articulation in objects:
        seed = int(hashlib.sha256(name.encode()).hexdigest()[:12], 16)
        yield from motion_samples(name, articulation, np.random.default_rng(seed))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="motions", description="Fit the evidence for motions to known ones."
    )
    parser.add_argument(
        "--data",
        type=Path,
        action="append",
        default=[],
        help="a folder of folders with URDF or MJCF",
    )
    parser.add_argument("--output", type=Path, required=True, help="the TOML to write")
    parser.add_argument("--seeds", type=int, default=6, help="generated objects of each category")
    parser.add_argument("--first-seed", type=int, default=500, help="of the generated objects")
    parser.add_argument("--every", type=int, default=1, help="learn from every n-th object only")
    parser.add_argument("--steps", type=int, default=250, help="of each optimisation at most")
    return parser


if __name__ == "__main__":
    sys.exit(main())
