"""How far answers for the same mesh from different samples agree, and which one stands for all."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ...mesh import FloatArray
from .decoding import Decoded
from .motion import PredictedMotion
from .prediction import MotionClass


@dataclass(frozen=True)
class Consensus:
    """The answer closest to all others.

    Attributes:
        chosen: that answer.
        samples: how many answers there were.
        part_agreement: for each of its parts, how well the other answers have it too, 0 to 1: area
            shared over area covered by the part and its match, 0 where the match moves in another
            way; ``None`` with one answer.
    """

    chosen: Decoded
    samples: int
    part_agreement: tuple[float, ...] | None


def consensus(readings: Sequence[Decoded], areas: npt.ArrayLike) -> Consensus:
    """Return the answer that agrees most with the others on average, the first of equals.

    ``areas`` are those of the mesh's faces, shape [face_count].
    """
    if len(readings) == 1:
        return Consensus(readings[0], 1, None)
    weights = np.asarray(areas, dtype=np.float64)
    support = [
        np.mean(
            [part_agreement(one, other, weights) for j, other in enumerate(readings) if j != i],
            axis=0,
        )
        for i, one in enumerate(readings)
    ]
    pairs = zip(readings, support, strict=True)
    best = int(np.argmax([_weighted(one, each, weights) for one, each in pairs]))
    return Consensus(readings[best], len(readings), tuple(float(x) for x in support[best]))


def part_agreement(one: Decoded, other: Decoded, areas: FloatArray) -> FloatArray:
    """Return how each part of ``one`` overlaps its match in ``other``, shape [part_count].

    Parts are matched one to one so that the overlaps add up to the most; unmatched ones have 0.
    """
    from scipy.optimize import linear_sum_assignment

    rows = len(one.parts)
    columns = len(other.parts)
    key = one.face_part * columns + other.face_part
    shared = np.bincount(key, weights=areas, minlength=rows * columns).reshape(rows, columns)
    covered = shared.sum(axis=1)[:, None] + shared.sum(axis=0)[None, :] - shared
    overlap = shared / np.where(covered > 0.0, covered, 1.0)
    theirs = [_effective(other, part) for part in range(columns)]
    alike = [[_alike(_effective(one, part), each) for each in theirs] for part in range(rows)]
    score = overlap * np.array(alike)
    matched = np.zeros(rows)
    for i, j in zip(*linear_sum_assignment(-score), strict=True):
        matched[i] = score[i, j]
    return matched


def _effective(reading: Decoded, part: int) -> PredictedMotion | None:
    """Return the part's motion; the root's is not carried out."""
    return None if part == reading.root else reading.parts[part].motion


def _alike(one: PredictedMotion | None, other: PredictedMotion | None) -> float:
    """Return 1 for the same class and parallel axes, 0 for perpendicular ones or others."""
    if one is None or other is None or one.kind != other.kind:
        moving = (each is not None and each.kind is not MotionClass.FIXED for each in (one, other))
        return 0.0 if any(moving) else 1.0
    likeness = 1.0
    if one.axis is not None and other.axis is not None:
        likeness *= abs(float(one.axis.direction @ other.axis.direction))
    if one.slide_direction is not None and other.slide_direction is not None:
        likeness *= abs(float(one.slide_direction @ other.slide_direction))
    return likeness


def _weighted(reading: Decoded, support: FloatArray, areas: FloatArray) -> float:
    """Return half the mean support of parts, and half that of bits of surface."""
    share = np.bincount(reading.face_part, weights=areas, minlength=len(reading.parts))
    whole = max(float(share.sum()), np.finfo(np.float64).tiny)
    return float((support.mean() + support @ share / whole) / 2.0)
