"""The ``factory`` command: parse, call one function, leave with its exit code."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Sequence
from typing import Annotated

import tyro

from ..errors import AssetFactoryError
from ..runtime import exits
from . import build, check, demos, nightly, predict, registry, solve, weights
from . import evaluate as evaluation
from . import train as training

Command = (
    Annotated[build.Build, tyro.conf.subcommand("build")]
    | Annotated[nightly.Nightly, tyro.conf.subcommand("nightly")]
    | Annotated[predict.Predict, tyro.conf.subcommand("predict")]
    | Annotated[check.Check, tyro.conf.subcommand("check")]
    | Annotated[registry.List, tyro.conf.subcommand("list")]
    | Annotated[registry.Show, tyro.conf.subcommand("show")]
    | Annotated[registry.RegistryCommand, tyro.conf.subcommand("registry")]
    | Annotated[solve.Solve, tyro.conf.subcommand("solve")]
    | Annotated[weights.WeightsCommand, tyro.conf.subcommand("weights")]
    | Annotated[demos.Demos, tyro.conf.subcommand("demos")]
    | Annotated[evaluation.Evaluate, tyro.conf.subcommand("evaluate")]
    | Annotated[training.Train, tyro.conf.subcommand("train")]
)

ACTIONS: dict[type, Callable[..., int]] = {
    build.Build: build.run,
    nightly.Nightly: nightly.run,
    predict.Predict: predict.run,
    check.Check: check.run,
    registry.List: registry.run_list,
    registry.Show: registry.run_show,
    registry.RegistryCommand: registry.run,
    solve.Solve: solve.run,
    weights.WeightsCommand: weights.run,
    demos.Demos: demos.run,
    evaluation.Evaluate: evaluation.run,
    training.Train: training.run,
}


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line and leave with its exit code."""
    sys.exit(run(arguments))


def run(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code. Wrong usage raises SystemExit(2)."""
    options = (tyro.conf.FlagCreatePairsOff,)
    command = tyro.cli(Command, args=arguments, prog="factory", description=__doc__, config=options)
    try:
        return ACTIONS[type(command)](command)
    except AssetFactoryError as error:
        print(f"factory: {error}", file=sys.stderr)
        return exits.USAGE
    except KeyboardInterrupt:
        print("factory: interrupted; what was finished is registered", file=sys.stderr, flush=True)
        # Worker processes follow this one; waiting for their threads would wait for their work.
        os._exit(exits.INTERRUPTED)
