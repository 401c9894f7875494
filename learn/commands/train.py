"""``factory train``: flags, and the call."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated

import tyro
from tyro.conf import Positional

from asset_factory.factory.errors import ConfigError, Exit
from asset_factory.factory.runtime.terminal import say


@dataclass(frozen=True)
class Train:
    """Train the network of parts and joints from a recipe.

    Under torchrun, several processes share the work. An interrupt or SIGTERM ends the run after a
    checkpoint.
    Exit codes: 0 all steps are done; 130 it was asked to stop before; 2 wrong usage.

    Example: factory train laptop --output run/
    """

    recipe: Positional[str]
    """A shipped recipe (laptop, paper, skins, small), or a TOML file: config.toml of a run."""
    output: Path | None = None
    """Folder for weights, checkpoints, curves and a card; without it the recipe is printed."""
    resume: bool = False
    """Go on with the run in that folder, as if it had not stopped."""
    start: Annotated[Path | None, tyro.conf.arg(name="from")] = None
    """Weights to begin with: model.safetensors or a checkpoint of a run of the same network."""
    device: str | None = None
    """auto, cpu, cuda or cuda:<n>; the recipe says by default."""
    threads: int | None = None
    """Of each process on the CPU; 0: as torch decides. The recipe says by default."""
    workers: int | None = None
    """Processes that draw samples, per trainer; 0: none. The recipe says by default."""


def run(command: Train) -> int:
    """Train, or print the recipe where no output is asked for; returns the exit code.

    Raises:
        ConfigError: no such recipe, or as :func:`train`.
    """
    from ..train.recipes import load_train_config, recipe_text

    if command.output is not None or command.resume or command.start is not None:
        return Exit.OK if train(command) else Exit.INTERRUPTED
    load_train_config(command.recipe)
    say(recipe_text(command.recipe), end="")
    return Exit.OK


def train(command: Train) -> bool:
    """Train; returns whether all steps are done.

    Raises:
        ConfigError: the recipe, the data or the folder cannot be used, or the run cannot go on.
    """
    from asset_factory.factory.cli.flags import given

    from ..train.recipes import load_train_config, recipe_text

    config = load_train_config(command.recipe)
    recipe = recipe_text(command.recipe)
    run = given(command, "device", "threads", "workers")
    for name in ("threads", "workers"):
        if run.get(name, 0) < 0:
            raise ConfigError(f"--{name} must be at least 0, not {run[name]}")
    if command.output is None:
        raise ConfigError("--output: missing; name a folder for the weights and checkpoints")
    if command.resume and command.start is not None:
        said = "a run that goes on has its own weights"
        raise ConfigError(f"--from and --resume: {said}; give one of them")
    config = replace(config, run=replace(config.run, **run))
    try:
        from ..train.loop import run_training
    except ImportError as error:
        wanted = "pip install 'asset-factory[train]'"
        raise ConfigError(f"training needs {error.name}: {wanted}") from error
    output = command.output
    try:
        return run_training(config, recipe, output, resume=command.resume, start=command.start)
    except OSError as error:
        begun = (output / "config.toml").is_file()
        more = "; what was stored before is whole, and --resume goes on" if begun else ""
        said = f"{error.filename or output}: {error.strerror or error}"
        raise ConfigError(f"{said}{more}") from error
