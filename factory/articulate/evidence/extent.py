"""How far a part goes: as far as such parts do, and no further than the way is free."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...articulation import JointKind
from ...mesh.mesh import FloatArray
from .body import Body
from .candidates import Candidates
from .guess import Guess
from .rating import load_usual
from .setting import setting_of

#: No range is shorter than this share of what was hoped for: what meets something at once was seen wrongly.
LEAST = 0.25


@dataclass(frozen=True)
class Extent:
    """How far one candidate goes.

    Attributes:
        kind: of the joint.
        lower, upper: limits [rad] or [m].
        share: of what was hoped for that the part got before it met what holds it, 0 to 1.
    """

    kind: JointKind
    lower: float
    upper: float
    share: float


def extent_of(body: Body, chosen: Candidates, evidence: FloatArray, guess: Guess) -> Extent:
    """Limits of one candidate.

    Args:
        body: the part.
        chosen: exactly one candidate.
        evidence: its numbers, shape [len(NAMES)].
        guess: whose ``upper`` is weighed against what is usual, if it speaks of the same kind.
    """
    setting = setting_of(body, chosen, evidence)
    said = guess.upper if guess.turns is None or (guess.turns < 0.5) == setting.slides else None
    if said is not None and not said > 0.0:
        said = None
    hoped = load_usual(setting.slides).range(setting, None if said is None else said / setting.unit)
    if np.isinf(hoped):
        return Extent(JointKind.CONTINUOUS, -np.pi, np.pi, 1.0)
    share = min(setting.stop / hoped, 1.0)
    kind = JointKind.PRISMATIC if setting.slides else JointKind.REVOLUTE
    return Extent(kind, 0.0, hoped * setting.unit * max(share, LEAST), share)


def single(candidates: Candidates, index: int) -> Candidates:
    """One of them, as candidates."""
    at = slice(index, index + 1)
    return Candidates(
        candidates.slides[at], candidates.axis[at], candidates.origin[at], candidates.source[at], candidates.radius[at]
    )


def nearest_to(axis: FloatArray, origin: FloatArray, point: FloatArray) -> FloatArray:
    """The point of a line nearest to another [m], shape [3]."""
    return np.asarray(origin + axis * float(axis @ (point - origin)))
