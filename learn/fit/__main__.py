"""Fit the small networks that the maker ships: weights, and a card beside them.

    python -m asset_factory.learn.fit agreement configs/weights/agreement.safetensors --real FOLDER
    python -m asset_factory.learn.fit motions configs/weights/evidence.safetensors
    python -m asset_factory.learn.fit rectangles configs/weights/rectangles.safetensors --kept rows/
    python -m asset_factory.learn.fit sides configs/weights/seams.safetensors --kept views/
    python -m asset_factory.learn.fit trust configs/weights/trust.safetensors

Sides take hours of one core, the others up to one.
"""

from __future__ import annotations

import argparse
import sys
from itertools import chain, islice
from pathlib import Path

import numpy as np

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.models.shipped import Arrays
from asset_factory.factory.runtime.terminal import complain, say

from ..datasets.objects import described, generated
from ..datasets.split import read_split
from .making import keep_described_views, keep_views, kept_rows
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


def _sides(asked: Asked) -> Fit:
    from .sides import fit_sides

    asked.kept.mkdir(parents=True, exist_ok=True)
    keep_views(asked.kept, asked.seed, asked.objects)
    data = f"{asked.objects} generated objects"
    if asked.described is not None:
        keep_described_views(asked.kept, asked.seed, asked.described, np.radians(asked.turn))
        data += f", and those of {asked.described.name}"
    arrays, figures = fit_sides(asked.kept, asked.kept / "state.pt", asked.rounds, asked.seed)
    what = (
        "A picture network: of one side of an object it tells which pixels open, where what opens "
        "ends, and how it opens. `factory/articulate/seams/sight.py` asks it."
    )
    figures = f"on one file in 25, not learned from: {figures}"
    return Fit(Arrays(asked.output, arrays, {}), what, data, figures)


def _rectangles(asked: Asked) -> Fit:
    from .rectangles import fit_rectangles, report

    asked.kept.mkdir(parents=True, exist_ok=True)
    rows = [kept_rows(asked.kept, asked.seed, number) for number in range(asked.objects)]
    stored = fit_rectangles(rows, asked.seed)
    what = (
        "Two small networks: which rectangle on a side is a panel, and how a panel opens. "
        "`factory/articulate/seams/learned.py` asks them."
    )
    figures = f"of four fifths of the objects on the last fifth: {report(rows, asked.seed)}"
    return Fit(stored, what, f"{asked.objects} generated objects", figures)


def _motions(asked: Asked) -> Fit:
    from .motions import fit_motions, measured, report

    objects = chain(
        generated(range(asked.seed, asked.seed + asked.seeds)),
        *(described(folder) for folder in asked.data),
    )
    samples = list(measured(islice(objects, 0, None, asked.every)))
    stored = fit_motions(samples, asked.steps)
    what = (
        "Four small networks: which motion of a part the evidence speaks for, where somebody "
        "guessed one and where nobody did, and how far what turns or slides goes. "
        "`factory/articulate/evidence` asks them."
    )
    data = f"{len(samples)} parts of {len({each.name for each in samples})} objects"
    return Fit(stored, what, data, report(stored, samples))


def _trust(asked: Asked) -> Fit:
    from asset_factory.factory.articulate.auto.articulator import load_auto
    from asset_factory.factory.articulate.auto.trust import SIGNS, Trust
    from asset_factory.factory.config import AutoConfig, ParticulateConfig
    from asset_factory.factory.models.perceptron import linear

    from .trust import described_turned, fit_trust, procedural, tried

    articulator = load_auto(
        ParticulateConfig(), AutoConfig(), Trust(linear(np.zeros(len(SIGNS))), 0.5)
    )
    objects = chain(
        procedural(range(asked.seed, asked.seed + asked.seeds)),
        *(
            described_turned(folder, read_split(split))
            for folder, split in zip(asked.data, asked.split, strict=True)
        ),
    )
    trials = list(tried(articulator, objects))
    stored = fit_trust(articulator, trials, asked.least)
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

    from ..detector.real import real_objects
    from .agreement import fit_agreement, rate_parts, report

    guess = load_auto(ParticulateConfig(), AutoConfig())
    rated = rate_parts(guess, real_objects(asked.real, held_out=True))
    stored = fit_agreement(rated)
    what = (
        "Two logistic models: how likely a part is there that rules or another network propose, "
        "and one that only the detector sees. `factory/articulate/detected` asks them."
    )
    data = f"the meshes of {asked.real.name} that the detector did not learn from"
    return Fit(stored, what, data, report(rated))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m asset_factory.learn.fit",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    commands = parser.add_subparsers(required=True)
    motions = commands.add_parser("motions", help="how evidence for motions weighs, usual ranges")
    rectangles = commands.add_parser("rectangles", help="which are panels, and how panels open")
    sides = commands.add_parser("sides", help="the picture network of sides")
    trust = commands.add_parser("trust", help="in each source of auto")
    agreement = commands.add_parser("agreement", help="between the detector and others")
    agreement.add_argument("--real", type=Path, required=True, help="folder of labelled meshes")
    named = (
        (agreement, _agreement), (motions, _motions), (rectangles, _rectangles), (sides, _sides),
        (trust, _trust),
    )  # fmt: skip
    for command, fit in named:
        command.set_defaults(fit=fit)
        command.add_argument("output", type=Path, help="file to write, .safetensors")
        first = 500 if command is motions else 0
        command.add_argument("--seed", type=int, default=first, help="of objects, looks, weights")
    for command, count in ((rectangles, 314), (sides, 8000)):
        command.add_argument("--objects", type=int, default=count, help="generated to learn from")
        command.add_argument("--kept", type=Path, required=True, help="where those are kept")
    for command, count in ((motions, 6), (trust, 2)):
        command.add_argument("--seeds", type=int, default=count, help="objects of each category")
        command.add_argument(
            "--data", type=Path, action="append", default=[], help="folder of objects' folders"
        )
    motions.add_argument("--every", type=int, default=1, help="learn from every n-th object only")
    motions.add_argument("--steps", type=int, default=250, help="of each optimisation at most")
    sides.add_argument("--rounds", type=int, default=20, help="of training")
    sides.add_argument("--described", type=Path, help="folder with objects to learn from as well")
    sides.add_argument(
        "--turn", type=float, default=-90.0, help="that brings their fronts to -Y [deg]"
    )
    trust.add_argument(
        "--split", type=Path, action="append", default=[], help="names in each folder to use"
    )
    trust.add_argument("--least", type=float, help="probability to ask for; else one is looked for")
    return parser


if __name__ == "__main__":
    sys.exit(main())
