"""Everything that a run needs to go on as if it had never stopped."""

from __future__ import annotations

import textwrap
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import torch  # noqa: TID253 - this module is only imported to train

from asset_factory.factory.errors import ConfigError
from asset_factory.factory.models.weights.checkpoint import load_tensors, open_checkpoint
from asset_factory.factory.runtime.store import writing

Tensor = Any
LAST = "last.pt"
BEST = "best.pt"
_FORMAT = 1
#: Letters of what differs between networks; there are hundreds of names.
MOST_SAID = 1000


@dataclass(frozen=True)
class State:
    """A run after so many steps; all chance of a step follows from the seed and its number.

    Attributes:
        mean: running mean of the weights.
        optimiser: its state.
        best: the highest score of a validation so far, and its step; ``None`` before the first.
        data: digest of the data.
        seconds: spent so far.
    """

    step: int
    weights: dict[str, Tensor]
    mean: dict[str, Tensor]
    optimiser: dict[str, Any]
    best: tuple[float, int] | None
    data: str
    seconds: float


def write_state(path: Path, state: State) -> None:
    """Write a checkpoint such that the file is always the old one or the new one, complete."""
    with writing(path, lasting=True) as stream:
        torch.save({"format": _FORMAT, **vars(state)}, stream)


def read_state(path: Path) -> State:
    """Return a checkpoint; nothing in the file is run.

    Raises:
        ConfigError: no such file, or not a checkpoint of a training.
    """
    try:
        stored = torch.load(path, map_location="cpu", weights_only=True)
        if (found := stored["format"]) != _FORMAT:
            raise ConfigError(f"{path}: a checkpoint of format {found}, want {_FORMAT}")
        if (best := stored["best"]) is not None:
            stored["best"] = float(best[0]), int(best[1])
        numbers = {"step": int(stored["step"]), "seconds": float(stored["seconds"])}
        return State(**{each.name: stored[each.name] for each in fields(State)} | numbers)
    except FileNotFoundError as error:
        raise ConfigError(f"{path}: no such file; there is no run to go on with") from error
    except ConfigError:
        raise
    except Exception as error:  # torch names many reasons, with as many types
        said = f"not a checkpoint of a training, or damaged: {error}"
        other = f"another run can begin --from {BEST} or from the weights beside it"
        raise ConfigError(f"{path}: {said}; {other}") from error


def read_weights(path: Path) -> dict[str, Tensor]:
    """Return the weights to start from: a checkpoint's running mean, or another file's weights.

    Raises:
        ConfigError: no such file, or no file of weights.
    """
    if path.suffix == ".pt":
        try:
            return read_state(path).mean
        except ConfigError:
            if not path.is_file():
                raise
    return load_tensors(open_checkpoint(path))


def fill(network: Any, weights: dict[str, Tensor], path: Path) -> None:
    """Give a network weights, all of them and no others.

    Raises:
        ConfigError: they are of another network; says what differs.
    """
    try:
        network.load_state_dict(weights)
    except RuntimeError as error:
        said = textwrap.shorten(str(error), MOST_SAID)
        raise ConfigError(f"{path}: weights of another network: {said}") from error
