"""One way to write a fit: safetensors, and a card beside it that says how it was made."""

from __future__ import annotations

import shlex
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from asset_factory.factory.mesh import FloatArray
from asset_factory.factory.models.perceptron import Perceptron, inputs_of
from asset_factory.factory.models.shipped import Arrays
from asset_factory.factory.models.weights.safetensors import write_arrays
from asset_factory.factory.runtime.store import write_whole

COMMAND = "python -m asset_factory.learn.fit"
TERMS = "Apache-2.0"


@dataclass(frozen=True)
class Fit:
    """A fit, and the text of its card.

    Attributes:
        stored: arrays by name, and what the file says about itself.
        what: what the weights are, and what asks them; a sentence or two.
        data: that they learned from.
        figures: how well they do, and on what.
    """

    stored: Arrays
    what: str
    data: str
    figures: str


def networks_stored(
    networks: Mapping[str, Perceptron],
    inputs: Mapping[str, Sequence[str]],
    others: Mapping[str, FloatArray] | None = None,
) -> Arrays:
    """Return small networks as a file holds them, with the names of their inputs, in order."""
    arrays = dict(others or {})
    for name, network in networks.items():
        arrays |= network.arrays(name)
    return Arrays(Path(), arrays, inputs_of(inputs))


def write_fit(path: Path, fit: Fit, arguments: Sequence[str], seed: int) -> None:
    """Write weights, and their card: a file of their name that ends in ``.md``.

    ``arguments`` are those of :data:`COMMAND` that made them, ``seed`` is of all chance.
    """
    write_arrays(path, fit.stored.arrays, fit.stored.metadata)
    rows = {
        "made by": f"`{COMMAND} {shlex.join(arguments)}`",
        "seed": str(seed),
        "data": fit.data,
        "figures": fit.figures,
        "terms": TERMS,
    }
    table = "\n".join(f"| {name} | {text} |" for name, text in rows.items())
    text = f"# {path.name}\n\n{fit.what}\n\n| | |\n|---|---|\n{table}\n"
    write_whole(path.with_suffix(".md"), text.encode())
