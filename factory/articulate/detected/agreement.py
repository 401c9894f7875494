"""How likely a part is there: what the detector sees of it, and how sure its proposer is."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.special import expit

from ...models.perceptron import Perceptron
from ...models.shipped import Arrays, load_shipped

FILE = "agreement.safetensors"
#: Networks of the file, and what they are given.
PROPOSED = "proposed"
ALONE = "alone"
SIGNS = {PROPOSED: ("support", "confidence"), ALONE: ("support",)}


@dataclass(frozen=True)
class Agreement:
    """Two logistic models, fitted to real meshes that the detector did not learn from.

    Attributes:
        proposed: of a part that somebody else proposes with some confidence.
        alone: of a part that only the detector sees.
        least: probability below which a part stays fixed.
    """

    proposed: Perceptron
    alone: Perceptron
    least: float

    def of_proposed(self, support: float, confidence: float) -> float:
        """Return the probability of a part that somebody else proposes."""
        return _chance(self.proposed, support, confidence)

    def of_alone(self, support: float) -> float:
        """Return the probability of a part that only the detector sees."""
        return _chance(self.alone, support)


@cache
def load_agreement() -> Agreement:
    """Return the network that comes with the package.

    Raises:
        ConfigError: the file is for other signs.
    """
    return agreement_of(load_shipped(FILE))


def agreement_of(stored: Arrays) -> Agreement:
    """Return what a file holds; errors as for :func:`load_agreement`."""
    proposed, alone = (Perceptron.read(stored, name, signs) for name, signs in SIGNS.items())
    return Agreement(proposed, alone, float(stored.arrays["least"][0]))


def _chance(network: Perceptron, *signs: float) -> float:
    return float(expit(network.scores(np.array(signs))[0]))
