"""Panels and how they open, learned: networks of a rectangle's features."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

from ...models.perceptron import Perceptron
from ...models.shipped import load_shipped

FILE = "rectangles.safetensors"


@cache
def load_judge(name: str, features: Sequence[str]) -> Perceptron:
    """Return one of those that come with the package; its scores are log-odds.

    Args:
        name: of the network in the file.
        features: that it is asked with, in order.

    Raises:
        ConfigError: the file is for other features.
    """
    return Perceptron.read(load_shipped(FILE), name, features)
