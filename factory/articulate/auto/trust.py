"""How far to trust a proposal: its features, weighed by how right they were on made objects."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.special import logit

from ...mesh import FloatArray
from ...models.perceptron import Perceptron
from ...models.shipped import Arrays, load_shipped

FILE = "trust.safetensors"
NAME = "trust"
SIGNS = (
    "geometric",  # 1 if only the rules of shape say so
    "learned",  # 1 if only the network says so
    "shared",  # 1 if both do
    "alike",  # 1 if both do and move it alike
    "agreement",  # of the network's views, 0 to 1
    "confidence",  # of the network in the part's points, log-odds
    "moves",  # of the network that it moves, log-odds
    "hangs",  # of the network in what it hangs on, log-odds
    "evidence",  # of the geometry in the motion, given the network's guess, log-odds
    "unguided",  # of the geometry in the motion, nothing given, log-odds
    "area",  # share of the mesh's area, log10
    "rivals",  # moving parts that the network sees, log2
)


@dataclass(frozen=True)
class Trust:
    """A logistic model of the signs.

    Attributes:
        network: from signs to one log-odds.
        least: confidence below which a part is left fixed.
    """

    network: Perceptron
    least: float

    def confidence(self, signs: Mapping[str, float]) -> float:
        """Return the probability that a proposal for which these signs speak is right, 0 to 1."""
        return self.network.chance(signs_of(signs))


def signs_of(values: Mapping[str, float]) -> FloatArray:
    """Return the signs in their order; those not given are 0.

    Raises:
        KeyError: no such sign.
    """
    unknown = set(values) - set(SIGNS)
    if unknown:
        raise KeyError(f"no sign {sorted(unknown)}; there are {', '.join(SIGNS)}")
    return np.array([values.get(name, 0.0) for name in SIGNS])


def log_odds(probability: float) -> float:
    """Return values bounded so that no single sign decides alone."""
    return float(logit(min(max(probability, 0.01), 0.99)))


@cache
def load_trust() -> Trust:
    """Return the trust that comes with the package.

    Raises:
        ConfigError: the file is for other signs.
    """
    return trust_of(load_shipped(FILE))


def trust_of(stored: Arrays) -> Trust:
    """Return what a file holds; errors as for :func:`load_trust`."""
    return Trust(Perceptron.read(stored, NAME, SIGNS), float(stored.arrays["least"][0]))
