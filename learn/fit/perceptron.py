"""One fitter of small networks: a loss of their scores, minimised by L-BFGS, deterministic."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.optimize import minimize

from asset_factory.factory.mesh import FloatArray
from asset_factory.factory.models.perceptron import FARTHEST, Perceptron

#: Of any precision.
Numbers = npt.NDArray[Any]
#: A loss of scores [n, answer_count], and its slope by each of them.
Loss = Callable[[FloatArray], tuple[float, FloatArray]]
#: Inputs that hardly vary are scaled as if they varied by so much.
LEAST_SCALE = 0.02


@dataclass(frozen=True)
class Weighing:
    """Prior knowledge of some weights: the standard deviation of the first ones, and their decay.

    Half of their squares, times the decay, is added to the loss.
    """

    spread: float
    decay: float


@dataclass(frozen=True)
class FitSettings:
    """How a network is fitted.

    Attributes:
        width: of its hidden layer; 0: a linear model.
        answers: how many scores it gives.
        weights: of a :class:`Perceptron`, those that are fitted, in its order; others are 0.
        steps: of the optimisation at most.
        seed: of the first weights.
    """

    width: int
    answers: int
    weights: Mapping[str, Weighing]
    steps: int
    seed: int = 0

    def shapes(self, inputs: int) -> dict[str, tuple[int, int]]:
        """Return the fitted weights' shapes, for so many inputs."""
        shapes = {
            "inner": (inputs, self.width),
            "offset": (1, self.width),
            "outer": (self.width, self.answers),
            "base": (1, self.answers),
            "direct": (inputs, self.answers),
        }
        return {name: shape for name, shape in shapes.items() if name in self.weights}


def fit_perceptron(numbers: Numbers, loss: Loss, settings: FitSettings) -> Perceptron:
    """Return the network of the least loss of the scores of all rows, weights' squares added.

    Sums over ``numbers``, inputs of shape [n, input_count], are taken in their own precision.
    """
    shapes = settings.shapes(numbers.shape[1])
    sizes = [int(np.prod(shape)) for shape in shapes.values()]
    spread = np.repeat([settings.weights[name].spread for name in shapes], sizes)
    decay = np.repeat([settings.weights[name].decay for name in shapes], sizes)

    def unpacked(flat: FloatArray) -> dict[str, FloatArray]:
        parts = np.split(flat, np.cumsum(sizes)[:-1])
        return {name: part.reshape(shapes[name]) for name, part in zip(shapes, parts, strict=True)}

    def objective(flat: FloatArray) -> tuple[float, FloatArray]:
        weights = unpacked(flat.astype(numbers.dtype))
        value, slopes = _sloped(numbers, weights, loss)
        gradient = np.concatenate([slopes[name].ravel() for name in shapes]).astype(np.float64)
        return value + 0.5 * float(decay * flat @ flat), gradient + decay * flat

    start = spread * np.random.default_rng(settings.seed).normal(size=sum(sizes))
    best = minimize(
        objective, start, jac=True, method="L-BFGS-B", options={"maxiter": settings.steps}
    )
    found = unpacked(np.asarray(best.x))
    width = settings.width
    answers = settings.answers
    return Perceptron(
        inner=found.get("inner", np.zeros((numbers.shape[1], width))),
        offset=found.get("offset", np.zeros(width)).ravel(),
        outer=found.get("outer", np.zeros((width, answers))),
        base=found.get("base", np.zeros(answers)).ravel(),
        direct=found.get("direct"),
    )


def _sloped(
    numbers: Numbers, weights: Mapping[str, FloatArray], loss: Loss
) -> tuple[float, dict[str, FloatArray]]:
    """Return the loss of some weights, and its slope by each of them."""
    scores = np.zeros((len(numbers), 1), numbers.dtype) + weights.get("base", 0.0)
    if "inner" in weights:
        hidden = np.tanh(numbers @ weights["inner"] + weights["offset"])
        scores = scores + hidden @ weights["outer"]
    if "direct" in weights:
        scores = scores + numbers @ weights["direct"]
    value, slope = loss(scores.astype(np.float64))
    slope = slope.astype(numbers.dtype)
    slopes = {"base": slope.sum(axis=0), "direct": numbers.T @ slope}
    if "inner" in weights:
        back = slope @ weights["outer"].T * (1.0 - hidden * hidden)
        slopes |= {"inner": numbers.T @ back, "offset": back.sum(axis=0), "outer": hidden.T @ slope}
    return value, slopes


@dataclass(frozen=True)
class Examples:
    """Rows with answers that are known.

    Attributes:
        rows: numbers, shape [n, input_count].
        wanted: probability of each answer, shape [n, answer_count]; one column: of yes.
        weights: of each row, shape [n].
    """

    rows: FloatArray
    wanted: FloatArray
    weights: FloatArray

    def cross_entropy(self, scores: FloatArray) -> tuple[float, FloatArray]:
        """Return the mean weighted cross entropy, and its slope by the scores [n, answer_count]."""
        share = self.weights / self.weights.sum()
        if self.wanted.shape[1] == 1:
            yes = 1.0 / (1.0 + np.exp(-scores))
            entropy = (np.logaddexp(0.0, scores) - self.wanted * scores)[:, 0]
            return float(share @ entropy), share[:, None] * (yes - self.wanted)
        scores = scores - scores.max(axis=1, keepdims=True)
        chances = np.exp(scores)
        chances /= chances.sum(axis=1, keepdims=True)
        entropy = -(self.wanted * np.log(np.maximum(chances, 1e-12))).sum(axis=1)
        return float(share @ entropy), share[:, None] * (chances - self.wanted)


def fit_examples(examples: Examples, settings: FitSettings) -> Perceptron:
    """Return the network of the least cross entropy; its inputs are scaled as they vary."""
    mean = examples.rows.mean(axis=0)
    scale = np.maximum(examples.rows.std(axis=0), LEAST_SCALE)
    rows = np.clip((examples.rows - mean) / scale, -FARTHEST, FARTHEST)
    found = fit_perceptron(rows, examples.cross_entropy, settings)
    return replace(found, mean=mean, scale=scale)
