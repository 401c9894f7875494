"""The small weights that come with the package: arrays in ``configs/weights``, a card beside each.

A card names the command and the seed that made the file, what it learned from, and its figures.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from ..mesh import FloatArray
from .weights.safetensors import read_safetensors
from .weights.sources import shipped_file


@dataclass(frozen=True, eq=False)
class Arrays:
    """A file of arrays.

    Attributes:
        file: where.
        arrays: by name, as they are stored.
        metadata: what the file says about itself.
    """

    file: Path
    arrays: Mapping[str, FloatArray]
    metadata: Mapping[str, str]


@cache
def load_shipped(name: str) -> Arrays:
    """Return a file of ``configs/weights``. Raises ConfigError: it is damaged."""
    return load_arrays(shipped_file(name))


def load_arrays(file: Path) -> Arrays:
    """Return a safetensors file of plain arrays, read-only; imports no torch.

    Raises:
        ConfigError: not such a file, damaged, or an array of a type that numpy has not.
    """
    stored = read_safetensors(file)
    arrays = stored.load(framework="numpy")
    for array in arrays.values():
        array.setflags(write=False)
    return Arrays(file, arrays, stored.metadata)
