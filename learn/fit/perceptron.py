"""One fitter of small networks: a loss of their scores, minimised by L-BFGS, deterministic."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt
import torch  # noqa: TID253 - this module is only imported to fit
from scipy.optimize import minimize
from torch.nn import functional  # noqa: TID253

from asset_factory.factory.mesh import FloatArray
from asset_factory.factory.models.perceptron import FARTHEST, Perceptron

Tensor = Any
#: Of any precision.
Numbers = npt.NDArray[Any]
#: A loss of scores, float64, shape [n, 1].
Loss = Callable[[Tensor], Tensor]
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
    """How a network of one answer is fitted.

    Attributes:
        width: of its hidden layer; 0: a linear model.
        weights: of a :class:`Perceptron`, those that are fitted, in its order; others are 0.
        steps: of the optimisation at most.
    """

    width: int
    weights: Mapping[str, Weighing]
    steps: int

    def shapes(self, inputs: int) -> dict[str, tuple[int, int]]:
        """Return the fitted weights' shapes, for so many inputs."""
        shapes = {
            "inner": (inputs, self.width),
            "offset": (1, self.width),
            "outer": (self.width, 1),
            "base": (1, 1),
            "direct": (inputs, 1),
        }
        return {name: shape for name, shape in shapes.items() if name in self.weights}


def fit_perceptron(numbers: Numbers, loss: Loss, settings: FitSettings) -> Perceptron:
    """Return the network of the least loss of the scores of all rows, weights' squares added.

    Sums over ``numbers``, inputs of shape [n, input_count], are taken in their own precision.
    """
    shapes = settings.shapes(numbers.shape[1])
    sizes = [int(np.prod(shape)) for shape in shapes.values()]
    spread = np.repeat([settings.weights[name].spread for name in shapes], sizes)
    decay = torch.tensor(np.repeat([settings.weights[name].decay for name in shapes], sizes))
    given = torch.from_numpy(numbers)

    def unpacked(flat: Tensor) -> dict[str, Tensor]:
        parts = zip(shapes.items(), flat.split(sizes), strict=True)
        return {name: part.view(shape) for (name, shape), part in parts}

    def objective(flat: FloatArray) -> tuple[float, FloatArray]:
        point = torch.tensor(flat, requires_grad=True)
        scores = _scores(given, unpacked(point.to(given.dtype)))
        value = loss(scores.double()) + 0.5 * (decay * point) @ point
        value.backward()
        return value.item(), point.grad.numpy()

    start = spread * np.random.default_rng(0).normal(size=sum(sizes))
    best = minimize(
        objective, start, jac=True, method="L-BFGS-B", options={"maxiter": settings.steps}
    )
    found = {name: part.numpy() for name, part in unpacked(torch.from_numpy(best.x)).items()}
    width = settings.width
    return Perceptron(
        inner=found.get("inner", np.zeros((numbers.shape[1], width))),
        offset=found.get("offset", np.zeros(width)).ravel(),
        outer=found.get("outer", np.zeros((width, 1))),
        base=found.get("base", np.zeros(1)).ravel(),
        direct=found.get("direct"),
    )


def _scores(given: Tensor, weights: Mapping[str, Tensor]) -> Tensor:
    """Return what weights make of rows, shape [n, 1]."""
    scores = given.new_zeros((len(given), 1)) + weights.get("base", 0.0)
    if "inner" in weights:
        hidden = torch.tanh(given @ weights["inner"] + weights["offset"])
        scores = scores + hidden @ weights["outer"]
    return scores + given @ weights["direct"] if "direct" in weights else scores


def cross_entropy(wanted: FloatArray) -> Loss:
    """Return the loss that is the mean cross entropy of scores; ``wanted``: chances, [n, 1]."""
    chances = torch.from_numpy(wanted)
    return lambda scores: functional.binary_cross_entropy_with_logits(scores, chances)


def fit_scaled(numbers: FloatArray, loss: Loss, settings: FitSettings) -> Perceptron:
    """Return what :func:`fit_perceptron` does, of inputs that are scaled as they vary."""
    mean = numbers.mean(axis=0)
    scale = np.maximum(numbers.std(axis=0), LEAST_SCALE)
    rows = np.clip((numbers - mean) / scale, -FARTHEST, FARTHEST)
    return replace(fit_perceptron(rows, loss, settings), mean=mean, scale=scale)
