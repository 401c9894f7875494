"""The most plausible motion of one part of a mesh, with what speaks for it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np

from ...mesh import BoolArray, FloatArray, read_only
from ..proposal import Motion
from .body import Body, Partition, body_of
from .candidates import Candidates, find_candidates
from .extent import LEAST, Extent, extent_of
from .guess import NOTHING, Guess
from .numbers import NAMES, measure
from .rating import Rating, load_rating
from .setting import is_small

#: Motions less probable than this are not worth a joint.
LEAST_CONFIDENCE = 0.25
#: Axes that agree to this cosine, and run this close as a share of the object's longest side, are
#: one motion.
LIKE_ANGLE = np.cos(np.radians(5.0))
LIKE_PLACE = 0.05
#: Share of the hoped-for range after which a way is free.
FREE = 0.9


@dataclass(frozen=True)
class MotionEvidence:
    """What the evidence says about one part.

    Attributes:
        motion: the most plausible one; ``None`` if none is plausible.
        confidence: probability that its kind is right, and its axis to 5 degrees and 5 % of the
            object's longest side; which way round is not part of it.
        turns: share of belief in turning rather than sliding, 0 to 1.
        numbers: the evidence for the chosen motion, in the order of ``numbers.NAMES``; zeros if
            there was none.
    """

    motion: Motion | None
    confidence: float
    turns: float = 0.5
    numbers: FloatArray = field(default_factory=lambda: np.zeros(len(NAMES)), repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "numbers", read_only(self.numbers))

    @property
    def evidence(self) -> Mapping[str, float]:
        """Return the numbers by name."""
        return MappingProxyType(dict(zip(NAMES, self.numbers.tolist(), strict=True)))


def best_motion(
    partition: Partition,
    part: int,
    guess: Guess = NOTHING,
    rating: Rating | None = None,
    least_confidence: float = LEAST_CONFIDENCE,
) -> MotionEvidence:
    """Return the most plausible motion of a part relative to the one it hangs on.

    Args:
        partition: the mesh in its closed pose, or with slides that stand open, shared out among
            parts.
        part: whose motion.
        guess: what somebody believes; with nothing in it the geometry decides alone.
        rating: how evidence weighs; the shipped one by default.
        least_confidence: below this the answer holds no motion, only evidence.
    """
    body = body_of(partition, part)
    if body is None:
        return MotionEvidence(None, 0.0)
    candidates = find_candidates(body, guess)
    numbers = measure(body, candidates, guess)
    weighed = rating or load_rating(guess.direction is not None)
    belief = beliefs(weighed.scores(numbers))
    chosen = int(np.argmax(belief))
    like = _alike(body, candidates, chosen)
    confidence = weighed.confidence(float(belief[like].sum()))
    turns = float(belief[~candidates.slides].sum())
    if confidence < least_confidence:
        return MotionEvidence(None, confidence, turns, numbers[chosen])
    return MotionEvidence(
        _motion(body, candidates, chosen, numbers, guess), confidence, turns, numbers[chosen]
    )


def beliefs(scores: FloatArray) -> FloatArray:
    """Return the shares of belief, one for each score, adding up to 1 (softmax)."""
    weights = np.exp(scores - scores.max())
    return np.asarray(weights / weights.sum())


def _motion(
    body: Body, candidates: Candidates, chosen: int, numbers: FloatArray, guess: Guess
) -> Motion:
    chosen, extent = _right_way(body, candidates, chosen, numbers, guess)
    middle = (body.corners.min(axis=0) + body.corners.max(axis=0)) / 2.0
    axis = candidates.axis[chosen]
    origin = candidates.origin[chosen]
    along = axis * float(axis @ (middle - origin))
    origin = middle if candidates.slides[chosen] else origin + along
    return Motion(extent.kind, axis, origin, extent.lower, extent.upper)


def _right_way(
    body: Body, candidates: Candidates, chosen: int, numbers: FloatArray, guess: Guess
) -> tuple[int, Extent]:
    """Return the chosen candidate, or its reverse where what holds the part stops it at once.

    Not so for buttons: they lie on the part that holds them.
    """
    extent = extent_of(body, candidates.at([chosen]), numbers[chosen], guess)
    pressed = bool(candidates.slides[chosen]) and is_small(numbers[chosen])
    if extent.share >= LEAST or pressed:
        return chosen, extent
    twin = chosen ^ 1
    other = extent_of(body, candidates.at([twin]), numbers[twin], guess)
    return (twin, other) if other.share >= FREE else (chosen, extent)


def _alike(body: Body, candidates: Candidates, chosen: int) -> BoolArray:
    """Tell which candidates have the chosen kind and axis, whichever way round, shape [n]."""
    aligned = np.abs(candidates.axis @ candidates.axis[chosen]) > LIKE_ANGLE
    alike = (candidates.slides == candidates.slides[chosen]) & aligned
    if candidates.slides[chosen]:
        return np.asarray(alike)
    apart = candidates.origin - candidates.origin[chosen]
    apart = apart - np.einsum("nj,nj->n", apart, candidates.axis)[:, None] * candidates.axis
    near = np.linalg.norm(apart, axis=1) < LIKE_PLACE * float(
        np.ptp(body.partition.mesh.bounds, axis=0).max()
    )
    return np.asarray(alike & near)
