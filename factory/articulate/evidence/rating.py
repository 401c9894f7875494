"""How much each candidate's evidence weighs: a small learned judgement, and how sure it may be."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any

import numpy as np

from ...mesh import FloatArray
from .numbers import NAMES
from .usual import Usual, usual_of

FILE = "evidence.toml"


@dataclass(frozen=True)
class Rating:
    """``score = tanh(numbers @ inner + offset) @ outer + numbers @ direct``, per candidate.

    Scores are compared among one part's candidates.

    Attributes:
        inner: shape [len(NAMES), h].
        offset: shape [h].
        outer: shape [h].
        direct: shape [len(NAMES)].
        sure: slope and offset of the logistic that makes a share of belief a probability of being
            right.
    """

    inner: FloatArray
    offset: FloatArray
    outer: FloatArray
    direct: FloatArray
    sure: tuple[float, float]

    def scores(self, numbers: FloatArray) -> FloatArray:
        """Score each candidate, higher is likelier; [n] for numbers of shape [n, len(NAMES)]."""
        return np.asarray(
            np.tanh(numbers @ self.inner + self.offset) @ self.outer + numbers @ self.direct
        )

    def confidence(self, belief: float) -> float:
        """Return the probability that the chosen motion is right, given its share of belief.

        The share counts the motion and its like.
        """
        bounded = float(np.clip(belief, 1e-4, 1.0 - 1e-4))
        slope, offset = self.sure
        return float(1.0 / (1.0 + np.exp(-(slope * np.log(bounded / (1.0 - bounded)) + offset))))


@cache
def load_rating(guided: bool) -> Rating:
    """Load the shipped ratings: for parts with a guessed motion, and for others."""
    return rating_of(_shipped()["guided" if guided else "blind"], FILE)


@cache
def load_usual(slides: bool) -> Usual:
    """Return the ranges that come with the package: for what slides, and for what turns."""
    return usual_of(_shipped()["slide_range" if slides else "turn_range"], slides, FILE)


@cache
def _shipped() -> dict[str, Any]:
    return tomllib.loads((resources.files("asset_factory") / "configs" / FILE).read_text())


def rating_of(table: dict[str, Any], file: str) -> Rating:
    """Read ratings from a table of the configuration.

    Raises:
        ValueError: its numbers are not those that are measured.
    """
    wrong = set(NAMES) ^ set(table["numbers"])
    if wrong:
        raise ValueError(
            f"{file}: its numbers are not those that are measured: {sorted(wrong)}; fit it again"
        )
    rows = np.array([table["numbers"][name] for name in NAMES], dtype=np.float64)
    slope, offset = table["sure"]
    return Rating(
        inner=rows[:, :-1],
        offset=np.array(table["offset"], dtype=np.float64),
        outer=np.array(table["outer"], dtype=np.float64),
        direct=rows[:, -1],
        sure=(float(slope), float(offset)),
    )
