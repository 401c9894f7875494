"""Small networks of at most one hidden layer, run in numpy: the same answer on every machine."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields

import numpy as np
from scipy.special import expit

from ..errors import ConfigError
from ..mesh import FloatArray
from .shipped import Arrays

#: Numbers farther than so many scales from what was learned from count as no farther.
FARTHEST = 4.0


@dataclass(frozen=True, eq=False)
class Perceptron:
    """``scores = tanh(x @ inner + offset) @ outer + base + x @ direct``.

    A hidden layer of width 0 leaves a linear model.

    Attributes:
        inner: weights into the hidden layer, shape [input_count, width].
        offset: added there, shape [width].
        outer: weights out of it, shape [width, answer_count].
        base: added there, shape [answer_count].
        direct: weights past the hidden layer, shape [input_count, answer_count]; ``None`` of a
            network that has none.
        mean, scale: of each input among those learned from, shape [input_count] each; ``None``
            where inputs are taken as they come.
    """

    inner: FloatArray
    offset: FloatArray
    outer: FloatArray
    base: FloatArray
    direct: FloatArray | None = None
    mean: FloatArray | None = None
    scale: FloatArray | None = None

    def scores(self, numbers: FloatArray) -> FloatArray:
        """Return every answer's score, shape [..., answer_count]; numbers [..., input_count]."""
        if self.mean is not None and self.scale is not None:
            numbers = np.clip((numbers - self.mean) / self.scale, -FARTHEST, FARTHEST)
        found = np.tanh(numbers @ self.inner + self.offset) @ self.outer + self.base
        if self.direct is not None:
            found = found + numbers @ self.direct
        return np.asarray(found)

    def chance(self, numbers: FloatArray) -> float:
        """Return the probability whose log-odds is the first score; numbers [input_count]."""
        return float(expit(self.scores(numbers)[0]))

    @classmethod
    def read(cls, stored: Arrays, name: str, inputs: Sequence[str]) -> Perceptron:
        """Return a network of a file, which is given the numbers called ``inputs``, in their order.

        Raises:
            ConfigError: it was fitted to other numbers.
        """
        known = json.loads(stored.metadata.get(f"{name}.inputs", "[]"))
        if known != list(inputs):
            wrong = sorted(set(known) ^ set(inputs)) or "another order"
            fitted = f"{name} was fitted to other numbers: {wrong}; fit it again"
            raise ConfigError(f"{stored.file.name}: {fitted}")
        given = {each.name: stored.arrays.get(f"{name}.{each.name}") for each in fields(cls)}
        return cls(**given)  # type: ignore[arg-type]

    def arrays(self, name: str) -> dict[str, FloatArray]:
        """Return what a file holds of this network under a name."""
        given = {f"{name}.{each.name}": getattr(self, each.name) for each in fields(self)}
        return {key: values for key, values in given.items() if values is not None}


def linear(weights: FloatArray) -> Perceptron:
    """Return the linear model of one answer that has these weights, shape [input_count]."""
    nothing = np.zeros((len(weights), 0))
    return Perceptron(nothing, np.zeros(0), np.zeros((0, 1)), np.zeros(1), weights[:, None])


def inputs_of(names: Mapping[str, Sequence[str]]) -> dict[str, str]:
    """Return what a file says of its networks' inputs, by network."""
    return {f"{name}.inputs": json.dumps(list(inputs)) for name, inputs in names.items()}
