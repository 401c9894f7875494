"""How far parts usually go: learned shares of belief over steps of range."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.special import softmax

from ...mesh import FloatArray
from ...models.perceptron import Perceptron
from ...models.shipped import Arrays
from .setting import SLIDE_SETTING, TURN_SETTING, Setting

#: A guessed range is that much off, as a standard deviation of its logarithm, or altogether wrong
#: this often.
GUESS_SPREAD = 0.2
GUESS_WRONG = 0.05
#: What is usual speaks so loud beside a guess: as a power of its shares of belief.
USUAL_VOICE = 0.5
#: A range this much off, as a logarithm, is worth less by a factor e.
WORTH = 0.15
#: Slides are counted in lengths of the part; the few that are longer were counted in next to
#: nothing.
LONGEST_SLIDE = 10.0
#: A guessed turn this far round has no end [rad].
ROUND = 0.95 * 2.0 * np.pi


@dataclass(frozen=True)
class Usual:
    """Scores of steps of range.

    Attributes:
        values: of the steps, in the setting's unit; infinite for turns without end, shape [k].
        network: from the numbers of a setting to a score per step.
    """

    values: FloatArray
    network: Perceptron

    def shares(self, numbers: FloatArray) -> FloatArray:
        """Return the share of belief in each step, shape [..., k] for numbers of shape [..., n]."""
        return np.asarray(softmax(self.network.scores(numbers), axis=-1))

    def range(self, setting: Setting, said: float | None) -> float:
        """Return the range that is right most nearly, in the setting's unit; or infinity.

        Args:
            setting: of the part.
            said: what somebody guesses, in the same unit.
        """
        shares = self.shares(setting.numbers)
        if said is not None:
            shares = shares**USUAL_VOICE * likelihood(said, self.values)
        return float(self.values[int(np.argmax(worth(self.values) @ shares))])


def likelihood(said: float, values: FloatArray) -> FloatArray:
    """Return how well each range explains a guess, up to a factor, shape of ``values``."""
    if said >= ROUND:
        return np.where(np.isinf(values) | (values >= ROUND), 1.0, GUESS_WRONG)
    off = np.log(np.where(np.isinf(values), 1.0, values) / said) / GUESS_SPREAD
    return np.asarray(np.where(np.isinf(values), 0.0, np.exp(-0.5 * off * off)) + GUESS_WRONG)


def worth(values: FloatArray) -> FloatArray:
    """Return what it is worth to say one range where another is right, 0 to 1, shape [k, k]."""
    finite = np.where(np.isinf(values), 1e6, values)
    return np.asarray(np.exp(-np.abs(np.log(finite[:, None] / finite[None])) / WORTH))


def usual_of(stored: Arrays, slides: bool) -> Usual:
    """Return the usual ranges of a file.

    Raises:
        ConfigError: its numbers are not those that are measured.
    """
    name, inputs = ("slide_range", SLIDE_SETTING) if slides else ("turn_range", TURN_SETTING)
    network = Perceptron.read(stored, name, inputs)
    values = stored.arrays[f"{name}.values"]
    kept = values <= LONGEST_SLIDE if slides else np.full(len(values), True)
    return Usual(
        values[kept], replace(network, outer=network.outer[:, kept], base=network.base[kept])
    )
