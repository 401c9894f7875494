"""Fit the small networks that the maker ships: weights, and a card beside them.

    python -m asset_factory.learn.fit agreement configs/weights/agreement.safetensors \
        --real FOLDER... --data ROOT
    python -m asset_factory.learn.fit motions configs/weights/evidence.safetensors
    python -m asset_factory.learn.fit trust configs/weights/trust.safetensors

Each takes up to an hour of one core.
"""

from __future__ import annotations

import argparse
import sys
from itertools import chain
from pathlib import Path

import numpy as np

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.runtime.terminal import complain, say

from ..datasets.objects import described, generated
from ..datasets.split import read_split
from .writing import Fit, write_fit

Asked = argparse.Namespace


def main(arguments: list[str] | None = None) -> int:
    """Parse, fit, write; 0, or 2 where there is nothing to learn from."""
    given = sys.argv[1:] if arguments is None else arguments
    asked = _parser().parse_args(given)
    try:
        fit: Fit = asked.fit(asked)
    except ConfigError as error:
        complain(error)
        return 2
    write_fit(asked.output, fit, given, asked.seed)
    say(f"{fit.data}: {fit.figures}; weights in {asked.output}")
    return 0


def _motions(asked: Asked) -> Fit:
    from .motions import fit_motions, measured, report

    seeds = range(asked.seed, asked.seed + asked.seeds)
    objects = chain(generated(seeds), *(described(folder) for folder in asked.data))
    samples = list(measured(objects))
    stored = fit_motions(samples, asked.steps)
    what = (
        "Two small networks: which motion of a part the evidence speaks for, where somebody "
        "guessed one and where nobody did. `factory/articulate/evidence` asks them."
    )
    data = f"{len(samples)} parts of {len({each.name for each in samples})} objects"
    return Fit(stored, what, data, report(stored, samples))


def _trust(asked: Asked) -> Fit:
    from asset_factory.factory.articulate.auto.articulator import load_auto
    from asset_factory.factory.articulate.auto.trust import SIGNS, Trust
    from asset_factory.factory.config import AutoConfig, ParticulateConfig
    from asset_factory.factory.models.perceptron import linear

    from .trust import CHARACTERS, fit_trust, tried, turned_at_random

    if len(asked.split) != len(asked.data):
        said = f"{len(asked.split)} for {len(asked.data)} folders of --data"
        raise ConfigError(f"--split: {said}; want one of each in turn")
    trusting_none = Trust(linear(np.zeros(len(SIGNS))), 0.5)
    articulator = load_auto(ParticulateConfig(), AutoConfig(), trusting_none)
    made = generated(range(asked.seed, asked.seed + asked.seeds), characters=CHARACTERS)
    folders = zip(asked.data, asked.split, strict=True)
    others = (described(folder, read_split(split)) for folder, split in folders)
    trials = list(tried(articulator, turned_at_random(chain(made, *others))))
    stored = fit_trust(articulator, trials)
    right = np.concatenate([trial.right for trial in trials])
    what = (
        "A logistic model of what speaks for a part that may move, and the probability below "
        "which it stays fixed. `factory/articulate/auto/trust.py` asks it."
    )
    data = f"{len(right)} proposals for {len(trials)} objects"
    return Fit(stored, what, data, f"{right.mean():.2f} of the proposals are right")


def _agreement(asked: Asked) -> Fit:
    from asset_factory.factory.articulate.auto.articulator import load_auto
    from asset_factory.factory.config import AutoConfig, ParticulateConfig

    from .agreement import fit_agreement, labelled_meshes, rate_parts, report

    guess = load_auto(ParticulateConfig(), AutoConfig())
    rated = rate_parts(guess, labelled_meshes(asked.real, asked.data))
    stored = fit_agreement(rated)
    what = (
        "Logistic models: how likely a part is there that rules or another network propose, a "
        "panel that only the detector sees, and a lid. `factory/articulate/detected` asks them."
    )
    data = (
        f"the meshes of {' and '.join(folder.name for folder in asked.real)} that the detector did "
        "not learn from, as they are and "
        "made one piece, and the objects of the develop half made one piece; of these as they are "
        "what others propose"
    )
    return Fit(stored, what, data, report(stored, rated))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m asset_factory.learn.fit",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    commands = parser.add_subparsers(required=True)
    motions = commands.add_parser("motions", help="how evidence for motions weighs")
    trust = commands.add_parser("trust", help="in each source of auto")
    agreement = commands.add_parser("agreement", help="between the detector and others")
    agreement.add_argument("--real", type=Path, nargs="+", required=True, help="labelled meshes")
    agreement.add_argument("--data", type=Path, required=True, help="root of the list's objects")
    # Its chance follows from the order of the meshes; the card says so.
    agreement.set_defaults(seed=0)
    named = ((agreement, _agreement), (motions, _motions), (trust, _trust))
    for command, fit in named:
        command.set_defaults(fit=fit)
        command.add_argument("output", type=Path, help="file to write, .safetensors")
    for command, first, count in ((motions, 500, 6), (trust, 0, 2)):
        command.add_argument("--seed", type=int, default=first, help="of objects, looks, weights")
        command.add_argument("--seeds", type=int, default=count, help="objects of each category")
        command.add_argument(
            "--data", type=Path, action="append", default=[], help="folder of objects' folders"
        )
    motions.add_argument("--steps", type=int, default=250, help="of each optimisation at most")
    trust.add_argument(
        "--split", type=Path, action="append", default=[], help="names in each folder to use"
    )
    return parser


if __name__ == "__main__":
    sys.exit(main())
