"""How much each candidate's evidence weighs: a small learned judgement, and how sure it may be."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.special import expit, logit

from ...mesh import FloatArray
from ...models.perceptron import Perceptron
from ...models.shipped import Arrays, load_shipped
from .numbers import NAMES

FILE = "evidence.safetensors"


@dataclass(frozen=True)
class Rating:
    """Scores of candidates by their evidence, compared among one part's candidates.

    Attributes:
        network: from the numbers of a candidate to one score.
        sure: slope and offset of the logistic that makes a share of belief a probability of being
            right.
    """

    network: Perceptron
    sure: tuple[float, float]

    def scores(self, numbers: FloatArray) -> FloatArray:
        """Score each candidate, higher is likelier; [n] for numbers of shape [n, len(NAMES)]."""
        return self.network.scores(numbers)[..., 0]

    def confidence(self, belief: float) -> float:
        """Return the probability that the chosen motion is right.

        Args:
            belief: share of belief in the motion and its like, 0 to 1.
        """
        slope, offset = self.sure
        return float(expit(slope * logit(np.clip(belief, 1e-4, 1.0 - 1e-4)) + offset))


@cache
def load_rating(guided: bool) -> Rating:
    """Return the shipped rating: for parts whose motion another source guessed, or for others."""
    return rating_of(load_shipped(FILE), "guided" if guided else "blind")


def rating_of(stored: Arrays, name: str) -> Rating:
    """Return a rating of a file.

    Raises:
        ConfigError: its numbers are not those that are measured.
    """
    slope, offset = stored.arrays[f"{name}.sure"]
    return Rating(Perceptron.read(stored, name, NAMES), (float(slope), float(offset)))
