"""How one part moves: class, axes and ranges of the network's answer, in its own frame."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.special import softmax

from ...errors import InputRejected
from ...mesh import FloatArray, IntArray
from .prediction import MotionClass, Prediction

LEAST_DIRECTION = 1e-8
"""Shorter vectors have no direction."""
AT_END = 0.02
"""A pose this close to an end of the range, as its share, is at that end.

Networks do not regress exact zeros.
"""


@dataclass(frozen=True)
class Line:
    """An axis, and how far the votes for it lie apart.

    Attributes:
        direction: unit, shape [3].
        point: shape [3].
        spread: median distance of the votes from the line; ``None`` where nobody votes.
    """

    direction: FloatArray
    point: FloatArray
    spread: float | None


@dataclass(frozen=True)
class PredictedMotion:
    """One part's motion relative to its parent.

    Attributes:
        kind: see :class:`MotionClass`; only what its axis and slide make possible.
        margin: probability of the predicted class less that of the runner-up, 0 to 1.
        axis: of the turn; ``None`` unless it turns.
        turn: lower and upper limit [rad], holding 0.
        slide_direction: unit, shape [3]; ``None`` unless it slides.
        slide: lower and upper limit, holding 0.
        notes: changes, each the end of a sentence about the part.
        probabilities: of each class, in the order of :class:`MotionClass`; empty where nobody says.
    """

    kind: MotionClass
    margin: float
    axis: Line | None = None
    turn: tuple[float, float] = (0.0, 0.0)
    slide_direction: FloatArray | None = None
    slide: tuple[float, float] = (0.0, 0.0)
    notes: tuple[str, ...] = ()
    probabilities: tuple[float, ...] = ()


def read_motion(prediction: Prediction, part: int, part_ids: IntArray) -> PredictedMotion:
    """Return the motion of one part that has points.

    Args:
        prediction: finite, but for votes.
        part: whose motion.
        part_ids: the part of every point, shape [point_count]; its points vote for the place of its
            axis.
    """
    probabilities = softmax(np.asarray(prediction.motion_logits[part], dtype=np.float64))
    kind = MotionClass(int(probabilities.argmax()))
    runner_up, best = np.sort(probabilities)[-2:]
    axis = _axis(prediction, part, part_ids) if kind.turns else None
    slide = unit(prediction.prismatic_direction[part]) if kind.slides else None
    notes: list[str] = []
    if kind.turns and axis is None:
        notes.append("turns about no direction: that motion is left out")
    if kind.slides and slide is None:
        notes.append("slides in no direction: that motion is left out")
    turn_limits = slide_limits = (0.0, 0.0)
    if axis is not None:
        turn_limits = holding_zero(prediction.revolute_range[part], "rad", notes)
    if slide is not None:
        slide_limits = holding_zero(prediction.prismatic_range[part], "of the longest side", notes)
    turns = MotionClass.REVOLUTE if axis is not None else MotionClass.FIXED
    slides = MotionClass.PRISMATIC if slide is not None else MotionClass.FIXED
    possible = MotionClass(turns | slides)
    return PredictedMotion(
        possible,
        float(best - runner_up),
        axis,
        turn_limits,
        slide,
        slide_limits,
        tuple(notes),
        tuple(probabilities),
    )


def unit(vector: npt.ArrayLike) -> FloatArray | None:
    """Return the vector's direction; ``None`` if it has none."""
    given = np.asarray(vector, dtype=np.float64)
    length = float(np.linalg.norm(given))
    return given / length if length > LEAST_DIRECTION else None


def holding_zero(limits: npt.ArrayLike, measure: str, notes: list[str]) -> tuple[float, float]:
    """Lower and upper limit that include 0, the input pose; changes are added to ``notes``."""
    low, high = (float(x) for x in np.asarray(limits, dtype=np.float64))
    if low > high:
        low, high = high, low
        notes.append(f"was predicted with its limits swapped: [{low:.4g}, {high:.4g}] {measure}")
    span = max(high, 0.0) - min(low, 0.0)
    if max(low, -high) > AT_END * span:
        notes.append(
            f"was predicted to move within [{low:.4g}, {high:.4g}] {measure} only; "
            "widened to its input pose"
        )
    low, high = (
        0.0 if side * end <= AT_END * span else end for side, end in ((-1.0, low), (1.0, high))
    )
    return low, high


def _axis(prediction: Prediction, part: int, part_ids: IntArray) -> Line | None:
    direction = unit(prediction.revolute_direction[part])
    if direction is None:
        return None
    if prediction.closest_points is None:
        assert prediction.revolute_moment is not None, "a prediction has the one or the other"  # noqa: S101
        raw = np.asarray(prediction.revolute_direction[part], dtype=np.float64)
        moment = np.asarray(prediction.revolute_moment[part], dtype=np.float64)
        return Line(direction, np.cross(moment, raw) / float(raw @ raw), None)
    votes = np.asarray(prediction.closest_points[part_ids == part], dtype=np.float64)
    require_finite_numbers(votes, "votes for an axis")
    point = np.median(votes, axis=0)
    off = votes - point
    away = off - np.outer(off @ direction, direction)
    return Line(direction, point, float(np.median(np.linalg.norm(away, axis=1))))


def require_finite_numbers(values: npt.NDArray[np.floating[Any]], what: str) -> None:
    """Raise InputRejected, ``prediction_not_finite``, where a network said NaN or infinity."""
    bad = int((~np.isfinite(values)).sum())
    if bad:
        message = f"{bad} of {values.size} numbers in the network's {what} are not finite"
        raise InputRejected(
            "prediction_not_finite",
            f"{message}; check its weights",
            value=float(bad),
            unit="numbers",
            limit=0.0,
        )
