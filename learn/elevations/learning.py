"""Small networks fitted to rows of features."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize

from asset_factory.factory.articulate.seams.learned import LearnedJudge
from asset_factory.factory.mesh import FloatArray


@dataclass(frozen=True)
class Examples:
    """What one network learns from.

    Attributes:
        rows: features, shape [n, feature_count].
        wanted: probability of each answer, shape [n, answer_count]; one column: of yes.
        weights: of each row, shape [n].
    """

    rows: FloatArray
    wanted: FloatArray
    weights: FloatArray


def fitted(examples: Examples, width: int, decay: float, seed: int) -> LearnedJudge:
    """Return a network of one hidden layer with the least weighted cross entropy.

    Args:
        examples: to be learned.
        width: of the hidden layer.
        decay: of the weights, squared, per row.
        seed: of the first weights.
    """
    mean = examples.rows.mean(axis=0)
    scale = np.maximum(examples.rows.std(axis=0), 0.02)
    rows = np.clip((examples.rows - mean) / scale, -4.0, 4.0)
    rows = np.pad(rows, ((0, 0), (0, 1)), constant_values=1.0)
    shapes = ((rows.shape[1], width), (width + 1, examples.wanted.shape[1]))
    cut = shapes[0][0] * shapes[0][1]
    rng = np.random.default_rng(seed)
    start = rng.normal(size=cut + shapes[1][0] * shapes[1][1]) / np.sqrt(rows.shape[1])
    share = examples.weights / examples.weights.sum()

    def loss(flat: FloatArray) -> tuple[float, FloatArray]:
        hidden = flat[:cut].reshape(shapes[0])
        out = flat[cut:].reshape(shapes[1])
        inner = np.pad(np.tanh(rows @ hidden), ((0, 0), (0, 1)), constant_values=1.0)
        logits = inner @ out
        entropy, slope = _cross_entropy(logits, examples.wanted)
        slope *= share[:, None]
        to_inner = (slope @ out.T)[:, :-1] * (1.0 - inner[:, :-1] ** 2)
        gradient = np.concatenate([(rows.T @ to_inner).ravel(), (inner.T @ slope).ravel()])
        value = float(share @ entropy) + decay * float(flat @ flat)
        return value, gradient + 2.0 * decay * flat

    best = minimize(loss, start, jac=True, method="L-BFGS-B", options={"maxiter": 400}).x
    return LearnedJudge(mean, scale, best[:cut].reshape(shapes[0]), best[cut:].reshape(shapes[1]))


def averaged(judges: Sequence[LearnedJudge]) -> LearnedJudge:
    """Return one network that gives the mean of the log-odds of several that share one examples."""
    outs = [judge.out[:-1] / len(judges) for judge in judges]
    bias = np.mean([judge.out[-1] for judge in judges], axis=0)
    return LearnedJudge(
        judges[0].mean,
        judges[0].scale,
        np.concatenate([judge.hidden for judge in judges], axis=1),
        np.concatenate([*outs, bias[None, :]]),
    )


def _cross_entropy(logits: FloatArray, wanted: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Of each row, and its slope by the logits."""
    if wanted.shape[1] == 1:
        yes = 1.0 / (1.0 + np.exp(-logits))
        entropy = np.logaddexp(0.0, logits) - wanted * logits
        return entropy[:, 0], yes - wanted
    logits = logits - logits.max(axis=1, keepdims=True)
    shares = np.exp(logits)
    shares /= shares.sum(axis=1, keepdims=True)
    return -(wanted * np.log(np.maximum(shares, 1e-12))).sum(axis=1), shares - wanted
