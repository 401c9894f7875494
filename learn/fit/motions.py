"""Fits how the evidence for motions weighs to samples of known motions."""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence

import numpy as np
import torch  # noqa: TID253 - this module is only imported to fit
from scipy.optimize import minimize
from scipy.special import softmax
from torch.nn.utils.rnn import pad_sequence  # noqa: TID253

from asset_factory.factory.articulate.evidence.numbers import NAMES
from asset_factory.factory.articulate.evidence.rating import Rating, rating_of
from asset_factory.factory.articulation import Articulation
from asset_factory.factory.mesh import FloatArray, IntArray
from asset_factory.factory.models.perceptron import Perceptron
from asset_factory.factory.models.shipped import Arrays

from ..motions.motion_sample import MotionSample, motion_samples
from .perceptron import FitSettings, Tensor, Weighing, fit_perceptron
from .writing import networks_stored

HIDDEN = 12
WEIGHING = {
    "inner": Weighing(0.15, 3e-3),
    "offset": Weighing(0.0, 0.0),
    "outer": Weighing(0.2, 3e-3),
    "direct": Weighing(0.0, 6e-3),
}
#: Of each part's candidates so many teach at most: half of them the best, the rest at random.
MOST_CANDIDATES = 56
#: What no candidate is worth less than, so that a part without a right one teaches little.
LEAST_WORTH = 1e-4


def fit_motions(samples: Sequence[MotionSample], steps: int) -> Arrays:
    """Fit both ratings to the same motion samples, in so many steps of each optimisation."""
    fitted = {name: fit_rating(each, steps) for name, each in _by_rating(samples).items()}
    networks = {name: each.network for name, each in fitted.items()}
    others = {f"{name}.sure": np.array(each.sure) for name, each in fitted.items()}
    return networks_stored(networks, dict.fromkeys(fitted, NAMES), others)


def _by_rating(samples: Sequence[MotionSample]) -> dict[str, Sequence[MotionSample]]:
    """Return what each rating is fitted to: parts as somebody guesses them, and as nobody does."""
    return {"guided": samples, "blind": [each.unguided() for each in samples]}


def measured(objects: Iterable[tuple[str, Articulation]]) -> Iterator[MotionSample]:
    """Yield what every object teaches; its name seeds its turn and which labels are spoilt."""
    for name, articulation in objects:
        seed = int(hashlib.sha256(name.encode()).hexdigest()[:12], 16)
        yield from motion_samples(name, articulation, np.random.default_rng(seed))


def report(stored: Arrays, samples: Sequence[MotionSample]) -> str:
    """Return how many of the parts' motions are found, those that were learned from."""
    shares = []
    for name, given in _by_rating(samples).items():
        rating = rating_of(stored, name)
        right = [each.right[int(np.argmax(rating.scores(each.numbers)))] for each in given]
        shares.append(f"{name} {np.mean(right):.3f}")
    return f"motions right of those learned from: {', '.join(shares)}"


def fit_rating(samples: Sequence[MotionSample], steps: int) -> Rating:
    """Return the weights by listwise logistic regression; confidence by two-fold cross-fitting."""
    folds: tuple[list[MotionSample], list[MotionSample]] = ([], [])
    for motion_sample in samples:
        folds[_digest(motion_sample.name) % 2].append(motion_sample)
    said: list[float] = []
    right: list[float] = []
    for held_out, others in (folds, folds[::-1]):
        if not others:
            continue
        rating = Rating(_weights(others, max(steps * 2 // 3, 1)), (1.0, 0.0))
        for motion_sample in held_out:
            belief = softmax(rating.scores(motion_sample.numbers))
            chosen = int(np.argmax(belief))
            said.append(float(belief[motion_sample.alike[chosen]].sum()))
            right.append(float(motion_sample.right[chosen]))
    return Rating(_weights(samples, steps), _calibrated(said, right))


def _weights(samples: Sequence[MotionSample], steps: int) -> Perceptron:
    """Return the network that scores the candidates of every part, by a listwise loss."""
    teaching = [_telling(motion_sample) for motion_sample in samples]
    taught = list(zip(samples, teaching, strict=True))
    numbers = np.concatenate([x.numbers[rows] for x, rows in taught]).astype(np.float32)
    counts = [len(rows) for rows in teaching]
    worths = [torch.from_numpy(np.log(x.worth[rows] + LEAST_WORTH)) for x, rows in taught]
    worth = pad_sequence(worths, batch_first=True)
    weights = torch.from_numpy(_weights_of(samples))

    def loss(scores: Tensor) -> Tensor:
        parts = scores[:, 0].split(counts)
        listed = pad_sequence(parts, batch_first=True, padding_value=-torch.inf)
        return (weights * (listed.logsumexp(1) - (listed + worth).logsumexp(1))).mean()

    return fit_perceptron(numbers, loss, FitSettings(HIDDEN, WEIGHING, steps))


def _telling(motion_sample: MotionSample) -> IntArray:
    """Return the rows of the candidates that teach, in order; the same ones each time."""
    order = np.argsort(-motion_sample.worth, kind="stable")
    if len(order) <= MOST_CANDIDATES:
        return np.sort(order)
    best = order[: MOST_CANDIDATES // 2]
    others = order[MOST_CANDIDATES // 2 :]
    rng = np.random.default_rng(_digest(motion_sample.name) + len(order))
    chosen = rng.choice(others, MOST_CANDIDATES - len(best), replace=False)
    return np.sort(np.concatenate([best, chosen]))


def _calibrated(said: Sequence[float], right: Sequence[float]) -> tuple[float, float]:
    """Return slope and offset of the logistic from belief to probability (Platt scaling)."""
    if not said:
        return 1.0, 0.0
    bounded = np.clip(said, 1e-4, 1.0 - 1e-4)
    odds = np.log(bounded / (1.0 - bounded))
    sign = 2.0 * np.array(right) - 1.0

    def loss(values: FloatArray) -> float:
        miss = np.logaddexp(0.0, -sign * (values[0] * odds + values[1])).mean()
        return float(miss + 1e-3 * ((values[0] - 1.0) ** 2 + values[1] ** 2))

    slope, offset = minimize(loss, [1.0, 0.0]).x
    return float(slope), float(offset)


def _weights_of(samples: Sequence[MotionSample]) -> FloatArray:
    """Return the weight of every sample: one over the root of how many its object has."""
    count = Counter(motion_sample.name for motion_sample in samples)
    weights = np.array([count[motion_sample.name] ** -0.5 for motion_sample in samples])
    return np.asarray(weights / weights.mean())


def _digest(name: str) -> int:
    return int(hashlib.sha256(name.encode()).hexdigest()[:8], 16)
