"""The most plausible motion of one part of a mesh, with what speaks for it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import softmax

from ...mesh import BoolArray
from ..proposal import Motion
from .body import Body, Partition, body_of
from .candidates import Candidates, find_candidates
from .extent import LEAST, Extent, extent_of, is_small
from .guess import NOTHING, Guess
from .numbers import measure
from .rating import load_rating

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
        motion: the most plausible one; ``None`` of a part that has no surface, or is all there is.
        confidence: probability that its kind is right, and its axis to 5 degrees and 5 % of the
            object's longest side; which way round is not part of it.
    """

    motion: Motion | None
    confidence: float


def best_motion(partition: Partition, part: int, guess: Guess = NOTHING) -> MotionEvidence:
    """Return the most plausible motion of a part relative to the one it hangs on.

    Args:
        partition: the mesh in its closed pose, or with slides that stand open, shared out among
            parts.
        part: whose motion.
        guess: what somebody believes; with nothing in it the geometry decides alone.
    """
    body = body_of(partition, part)
    if body is None:
        return MotionEvidence(None, 0.0)
    candidates = find_candidates(body, guess)
    numbers = measure(body, candidates, guess)
    rating = load_rating(guess.direction is not None)
    belief = softmax(rating.scores(numbers))
    chosen = int(np.argmax(belief))
    like = _alike(body, candidates, chosen)
    confidence = rating.confidence(float(belief[like].sum()))
    return MotionEvidence(_motion(body, candidates, chosen, guess), confidence)


def _motion(body: Body, candidates: Candidates, chosen: int, guess: Guess) -> Motion:
    chosen, extent = _right_way(body, candidates, chosen, guess)
    middle = (body.corners.min(axis=0) + body.corners.max(axis=0)) / 2.0
    axis = candidates.axis[chosen]
    origin = candidates.origin[chosen]
    along = axis * float(axis @ (middle - origin))
    origin = middle if candidates.slides[chosen] else origin + along
    return Motion(extent.kind, axis, origin, extent.lower, extent.upper)


def _right_way(body: Body, candidates: Candidates, chosen: int, guess: Guess) -> tuple[int, Extent]:
    """Return the chosen candidate, or its reverse where what holds the part stops it at once.

    Not so for buttons: they lie on the part that holds them.
    """
    extent = extent_of(body, candidates.at([chosen]), guess)
    pressed = bool(candidates.slides[chosen]) and is_small(body)
    if extent.share >= LEAST or pressed:
        return chosen, extent
    twin = chosen ^ 1
    other = extent_of(body, candidates.at([twin]), guess)
    return (twin, other) if other.share >= FREE else (chosen, extent)


def _alike(body: Body, candidates: Candidates, chosen: int) -> BoolArray:
    """Tell which candidates have the chosen kind and axis, whichever way round, shape [n]."""
    aligned = np.abs(candidates.axis @ candidates.axis[chosen]) > LIKE_ANGLE
    alike = (candidates.slides == candidates.slides[chosen]) & aligned
    if candidates.slides[chosen]:
        return np.asarray(alike)
    _, apart = candidates.about(candidates.origin[[chosen]])
    near = np.linalg.norm(apart[:, 0], axis=1) < LIKE_PLACE * body.partition.mesh.extents.max()
    return np.asarray(alike & near)
