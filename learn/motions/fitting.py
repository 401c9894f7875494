"""Fits ratings and usual ranges to samples: small networks, by L-BFGS, deterministic."""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize

from asset_factory.factory.articulate.evidence.motion import beliefs
from asset_factory.factory.articulate.evidence.rating import Rating
from asset_factory.factory.articulate.evidence.usual import Usual
from asset_factory.factory.errors import ConfigError
from asset_factory.factory.mesh import FloatArray, IntArray

from .motion_sample import MotionSample

HIDDEN = 12
RANGE_HIDDEN = 8
#: Penalty on squared weights: of ratings (twice that on their direct ones), and of ranges.
DECAY = 3e-3
RANGE_DECAY = 0.1
#: Steps of range: a quarter of an octave apart, from 5.6 degrees to a turn, and from a tenth of the
#: unit to twice it.
TURN_STEPS = np.pi / 2.0 * 2.0 ** (np.arange(-16, 9) / 4.0)
SLIDE_STEPS = 2.0 ** (np.arange(-14, 6) / 4.0)
#: Of each part's candidates so many teach at most: half of them the best, the rest at random.
MOST_CANDIDATES = 56
#: What no candidate is worth less than, so that a part without a right one teaches little.
LEAST_WORTH = 1e-4


@dataclass(frozen=True)
class Fitted:
    """Everything learned: :mod:`asset_factory.factory.articulate.evidence.rating`, ``.usual``."""

    guided: Rating
    blind: Rating
    turn_range: Usual
    slide_range: Usual


def fit_motions(motion_samples: Sequence[MotionSample], steps: int = 250) -> Fitted:
    """Everything from the same motion samples.

    Args:
        motion_samples: of many parts.
        steps: of each optimisation at most.

    Raises:
        ConfigError: nothing turns, or nothing slides, among the motion samples.
    """
    return Fitted(
        guided=fit_rating(motion_samples, steps),
        blind=fit_rating([motion_sample.unguided() for motion_sample in motion_samples], steps),
        turn_range=fit_usual(motion_samples, slides=False, steps=steps),
        slide_range=fit_usual(motion_samples, slides=True, steps=steps),
    )


def fit_rating(motion_samples: Sequence[MotionSample], steps: int = 250) -> Rating:
    """Return the weights by listwise logistic regression; confidence by two-fold cross-fitting."""
    rating = _weights(motion_samples, steps)
    fold = np.array([_digest(motion_sample.name) % 2 for motion_sample in motion_samples])
    said: list[float] = []
    right: list[float] = []
    for half in (0, 1):
        others = [
            motion_sample
            for motion_sample, k in zip(motion_samples, fold, strict=True)
            if k != half
        ]
        if not others:
            continue
        judge = _weights(others, max(steps * 2 // 3, 1))
        for motion_sample in (
            motion_sample
            for motion_sample, k in zip(motion_samples, fold, strict=True)
            if k == half
        ):
            belief = beliefs(judge.scores(motion_sample.numbers))
            chosen = int(np.argmax(belief))
            said.append(float(belief[motion_sample.alike[chosen]].sum()))
            right.append(float(motion_sample.right[chosen]))
    return Rating(
        rating.inner, rating.offset, rating.outer, rating.direct, _calibrated(said, right)
    )


def fit_usual(motion_samples: Sequence[MotionSample], slides: bool, steps: int = 250) -> Usual:
    """Return the shares of belief over steps of range, by logistic regression.

    Raises:
        ConfigError: no motion sample is of that kind.
    """
    known = [
        (x, x.setting)
        for x in motion_samples
        if x.setting is not None and x.setting.slides == slides and x.range > 0.0
    ]
    if not known:
        raise ConfigError(
            f"motions: nothing {'slides' if slides else 'turns'} among what is to be learned from"
        )
    numbers = np.array([setting.numbers for _, setting in known])
    ranges = np.array([motion_sample.range for motion_sample, _ in known])
    grid = SLIDE_STEPS if slides else TURN_STEPS
    finite = np.where(np.isinf(ranges), 1.0, ranges)
    step = np.abs(np.log(finite[:, None] / grid[None])).argmin(axis=1)
    step = np.where(np.isinf(ranges), len(grid), step)
    values = np.array(
        [
            np.median(ranges[step == k]) if (step == k).any() else value
            for k, value in enumerate(grid)
        ]
    )
    values = values if slides else np.append(values, np.inf)
    weights = _weights_of([motion_sample for motion_sample, _ in known])
    inner, offset, outer, base = _classify(numbers, step, len(values), weights, steps)
    return Usual(values, inner, offset, outer, base)


def _classify(
    numbers: FloatArray, step: IntArray, count: int, weights: FloatArray, steps: int
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    n, width = numbers.shape
    shapes = ((width, RANGE_HIDDEN), (RANGE_HIDDEN,), (RANGE_HIDDEN, count), (count,))
    target = np.eye(count)[step]

    def loss(values: FloatArray) -> tuple[float, FloatArray]:
        inner, offset, outer, base = _unpacked(values, shapes)
        hidden = np.tanh(numbers @ inner + offset)
        scores = hidden @ outer + base
        scores -= scores.max(axis=1, keepdims=True)
        shares = np.exp(scores)
        total = shares.sum(axis=1, keepdims=True)
        value = float((weights * (np.log(total[:, 0]) - scores[np.arange(n), step])).sum()) / n
        slope = weights[:, None] * (shares / total - target) / n
        back = slope @ outer.T * (1.0 - hidden**2)
        decay = RANGE_DECAY * np.concatenate([inner.ravel(), 0 * offset, outer.ravel(), 0.1 * base])
        gradient = np.concatenate(
            [
                (numbers.T @ back).ravel(),
                back.sum(axis=0),
                (hidden.T @ slope).ravel(),
                slope.sum(axis=0),
            ]
        )
        return value + 0.5 * float(decay @ values), gradient + decay

    return tuple(_unpacked(_minimum(loss, shapes, (0.15, 0.0, 0.2, 0.0), steps), shapes))  # type: ignore[return-value]


def _weights(motion_samples: Sequence[MotionSample], steps: int) -> Rating:
    teaching = [_telling(motion_sample) for motion_sample in motion_samples]
    numbers = np.concatenate(
        [x.numbers[rows] for x, rows in zip(motion_samples, teaching, strict=True)]
    ).astype(np.float32)
    counts = np.array([len(rows) for rows in teaching])
    owner = np.repeat(np.arange(len(motion_samples)), counts)
    starts = np.concatenate([[0], np.cumsum(counts)[:-1]])
    worth = (
        np.concatenate([x.worth[rows] for x, rows in zip(motion_samples, teaching, strict=True)])
        + LEAST_WORTH
    )
    weights = _weights_of(motion_samples)
    width = numbers.shape[1]
    shapes = ((width, HIDDEN), (HIDDEN,), (HIDDEN,), (width,))

    def loss(values: FloatArray) -> tuple[float, FloatArray]:
        inner, offset, outer, direct = (
            part.astype(np.float32) for part in _unpacked(values, shapes)
        )
        hidden = np.tanh(numbers @ inner + offset)
        scores = (hidden @ outer + numbers @ direct).astype(np.float64)
        shares = np.exp(scores - np.maximum.reduceat(scores, starts)[owner])
        total = np.add.reduceat(shares, starts)
        good = np.add.reduceat(shares * worth, starts)
        value = float((weights * (np.log(total) - np.log(good))).mean())
        slope = (
            weights[owner]
            * shares
            * (1.0 / total[owner] - worth / good[owner])
            / len(motion_samples)
        )
        slope = slope.astype(np.float32)
        back = slope[:, None] * outer * (1.0 - hidden * hidden)
        gradient = np.concatenate(
            [(numbers.T @ back).ravel(), back.sum(axis=0), hidden.T @ slope, numbers.T @ slope]
        )
        decay = DECAY * np.concatenate([inner.ravel(), 0 * offset, outer, 2.0 * direct]).astype(
            np.float64
        )
        return value + 0.5 * float(decay @ values), gradient.astype(np.float64) + decay

    inner, offset, outer, direct = _unpacked(
        _minimum(loss, shapes, (0.15, 0.0, 0.2, 0.0), steps), shapes
    )
    return Rating(inner, offset, outer, direct, (1.0, 0.0))


def _telling(motion_sample: MotionSample) -> IntArray:
    """Return the rows of the candidates that teach, in order; the same ones each time."""
    order = np.argsort(-motion_sample.worth, kind="stable")
    if len(order) <= MOST_CANDIDATES:
        return np.sort(order)
    best = order[: MOST_CANDIDATES // 2]
    others = order[MOST_CANDIDATES // 2 :]
    rng = np.random.default_rng(_digest(motion_sample.name) + len(order))
    return np.sort(
        np.concatenate([best, rng.choice(others, MOST_CANDIDATES - len(best), replace=False)])
    )


Shapes = Sequence[tuple[int, ...]]


def _unpacked(values: FloatArray, shapes: Shapes) -> list[FloatArray]:
    ends = np.cumsum([int(np.prod(shape)) for shape in shapes])[:-1]
    return [part.reshape(shape) for part, shape in zip(np.split(values, ends), shapes, strict=True)]


def _minimum(
    loss: Callable[[FloatArray], tuple[float, FloatArray]],
    shapes: Shapes,
    spreads: Sequence[float],
    steps: int,
) -> FloatArray:
    rng = np.random.default_rng(0)
    start = np.concatenate(
        [
            rng.normal(0.0, spread, int(np.prod(shape)))
            for shape, spread in zip(shapes, spreads, strict=True)
        ]
    )
    found = minimize(
        loss, start, jac=True, method="L-BFGS-B", options={"maxiter": steps, "maxcor": 20}
    )
    return np.asarray(found.x)


def _calibrated(said: Sequence[float], right: Sequence[float]) -> tuple[float, float]:
    """Slope and offset of the logistic from belief share to probability of being right (Platt)."""
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


def _weights_of(motion_samples: Sequence[MotionSample]) -> FloatArray:
    """An object of many parts counts more than one of few, but not in proportion, [samples]."""
    count = Counter(motion_sample.name for motion_sample in motion_samples)
    weights = np.array([count[motion_sample.name] ** -0.5 for motion_sample in motion_samples])
    return np.asarray(weights / weights.mean())


def _digest(name: str) -> int:
    return int(hashlib.sha256(name.encode()).hexdigest()[:8], 16)
