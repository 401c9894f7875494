"""How far a part goes: as far as such parts do, and no further than the way is free."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...articulation import JointKind
from ...mesh import FloatArray
from .body import Body
from .candidates import Candidates
from .guess import Guess
from .rating import load_usual
from .setting import Setting, is_small, setting_of

#: No range is shorter than this share of what was hoped for: what meets something at once was seen
#: wrongly.
LEAST = 0.25
#: A slide that stands out of its holder by more than this share of its range is open. Fronts have
#: some thickness.
OPEN = 0.2
#: Axes whose upright share is smaller are level, and of a part on them so much of its diagonal is
#: still inside.
LEVEL = 0.2
INSIDE = 0.02
#: Faces nearer than this share of the diagonal are one.
THICK = 0.01


@dataclass(frozen=True)
class Extent:
    """How far one candidate goes.

    Attributes:
        kind: of the joint.
        lower, upper: limits [rad] or [m].
        share: of the hoped range that the part moved before a fixed part stopped it, 0 to 1.
    """

    kind: JointKind
    lower: float
    upper: float
    share: float


def extent_of(body: Body, chosen: Candidates, evidence: FloatArray, guess: Guess) -> Extent:
    """Return the limits of one candidate.

    Args:
        body: the part.
        chosen: exactly one candidate.
        evidence: its numbers, shape [len(NAMES)].
        guess: whose ``upper`` is weighed against the usual one, if it speaks of the same kind.
    """
    setting = setting_of(body, chosen, evidence)
    said = guess.upper if guess.turns is None or (guess.turns < 0.5) == setting.slides else None
    if said is not None and not said > 0.0:
        said = None
    hoped = load_usual(setting.slides).range(setting, None if said is None else said / setting.unit)
    if np.isinf(hoped):
        return Extent(JointKind.CONTINUOUS, -np.pi, np.pi, 1.0)
    out = stands_out_by(body, chosen.axis[0]) if setting.slides and not is_small(evidence) else 0.0
    if out > OPEN * hoped * setting.unit:
        return _half_open(body, setting, out)
    share = min(setting.stop / hoped, 1.0)
    kind = JointKind.PRISMATIC if setting.slides else JointKind.REVOLUTE
    return Extent(kind, 0.0, hoped * setting.unit * max(share, LEAST), share)


def _half_open(body: Body, setting: Setting, out: float) -> Extent:
    """Return limits of a slide that stands open: a guess sees only the rest of its range."""
    whole = load_usual(True).range(setting, None) * setting.unit
    left = max(whole - out, 0.0)
    free = min(setting.stop * setting.unit, left)
    return Extent(JointKind.PRISMATIC, -out, free, 1.0)


def stands_out_by(body: Body, axis: FloatArray) -> float:
    """Return how far the front of a part inside its holder stands out of it along a level axis [m].

    Not negative. A handle is not the front, however far it stands out.
    """
    if abs(float(axis[2])) > LEVEL or not len(body.held):
        return 0.0
    mouth = float((body.held.points @ axis).max())
    inside = mouth - float((body.corners @ axis).min())
    return max(_front(body, axis) - mouth, 0.0) if inside > INSIDE * body.diagonal else 0.0


def _front(body: Body, axis: FloatArray) -> float:
    """Return where the last broad face of a part across an axis is along it [m].

    Broad: at least half as large as any.
    """
    along = np.sort(body.own.points[body.own.facing(axis)] @ axis)
    if not len(along):
        return -np.inf
    near = THICK * body.diagonal
    around = np.searchsorted(along, along + near, "right") - np.searchsorted(
        along, along - near, "left"
    )
    return float(along[around >= 0.5 * around.max()][-1])
