"""What was learned about panels, lids and how they open: small networks in a table of figures."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from importlib import resources

import numpy as np

from ...errors import ConfigError
from ...mesh import FloatArray

FILE = "seams.toml"


@dataclass(frozen=True, eq=False)
class LearnedJudge:
    """A network of one hidden layer.

    Attributes:
        mean, scale: of each feature among those learned from, shape [feature_count] each.
        hidden: weights of the hidden layer, the last row added, shape [feature_count + 1, width].
        out: likewise of the answer, shape [width + 1, answer_count].
    """

    mean: FloatArray
    scale: FloatArray
    hidden: FloatArray
    out: FloatArray

    def logits(self, features: FloatArray) -> FloatArray:
        """Return log-odds of each answer, [n, answer_count], for features [n, feature_count]."""
        # Beyond what was learned from, nothing more is concluded.
        scaled = np.clip((features - self.mean) / self.scale, -4.0, 4.0)
        inner = np.tanh(scaled @ self.hidden[:-1] + self.hidden[-1])
        return np.asarray(inner @ self.out[:-1] + self.out[-1])


@cache
def load_judge(name: str, features: Sequence[str]) -> LearnedJudge:
    """Return one of those that come with the package.

    Args:
        name: of its table in the file.
        features: that it is asked with, in order.

    Raises:
        ConfigError: the file is for other features.
    """
    path = resources.files("asset_factory") / "configs" / FILE
    table = tomllib.loads(path.read_text(encoding="utf-8"))[name]
    if table["features"] != list(features):
        raise ConfigError(f"{FILE}: {name} knows other features; learn it again")
    return LearnedJudge(*(np.array(table[key]) for key in ("mean", "scale", "hidden", "out")))
