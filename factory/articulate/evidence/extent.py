"""How far a part goes: until it meets something, and no further than such parts do."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...articulation import JointKind
from ...mesh.mesh import FloatArray
from .body import Body
from .candidates import Candidates
from .guess import Guess
from .travel import displaced

#: What turns and is not stopped opens to a right angle [rad]: the commonest limit by far of those that people give.
RIGHT_ANGLE = np.radians(90.0)
#: Share of their length that drawers come out, that panels slide, and that buttons go in.
DRAWER, PANEL, BUTTON = 0.82, 0.9, 0.6
#: Guessed limits this close to a usual one, as a share of it, mean that one.
NEARLY = 0.25
STEPS = 24
#: Share of the points that may meet something on the way more than at the start.
SLACK = 0.04
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


def extent_of(body: Body, chosen: Candidates, numbers: dict[str, float], guess: Guess) -> Extent:
    """Limits of one candidate.

    Args:
        body: the part.
        chosen: exactly one candidate.
        numbers: its evidence by name.
        guess: whose ``upper`` is believed where the way is free, if it speaks of the same kind.
    """
    slides = bool(chosen.slides[0])
    said = guess.upper if guess.turns is None or (guess.turns < 0.5) == slides else None
    ends = said is not None and said < 0.98 * 2.0 * np.pi
    if not slides and not ends and numbers["turn_round"] > 0.75 and numbers["turn_one_sided"] < 0.75:
        return Extent(JointKind.CONTINUOUS, -np.pi, np.pi, 1.0)
    usual = _usual_slide(body, numbers) if slides else RIGHT_ANGLE
    hoped = usual if said is None else _rounded(said, (usual,) if slides else (RIGHT_ANGLE, np.pi))
    share = _free_share(body, chosen, hoped)
    kind = JointKind.PRISMATIC if slides else JointKind.REVOLUTE
    return Extent(kind, 0.0, hoped * max(share, LEAST), share)


def _rounded(said: float, usual: tuple[float, ...]) -> float:
    """What was said or, if that is nearly what is usual, the usual."""
    near = [value for value in usual if abs(said - value) <= NEARLY * value]
    return near[0] if near else said


def is_small(numbers: dict[str, float]) -> bool:
    """Whether what slides is a button rather than a drawer, by its evidence."""
    return numbers["slide_small"] > 0.4


def _usual_slide(body: Body, numbers: dict[str, float]) -> float:
    share = BUTTON if is_small(numbers) else PANEL if numbers["slide_in_plane"] > 0.4 else DRAWER
    return max(numbers["slide_extent"] * share, 1e-3) * body.diagonal


def _free_share(body: Body, chosen: Candidates, hoped: float) -> float:
    """Share of what is hoped for before more than a few points meet what the part hangs on."""
    shares = np.arange(1, STEPS + 1) / STEPS
    hits = np.zeros(STEPS)
    for step, share in enumerate(shares):
        moved, headings, gone = displaced(chosen, body.probes.points, np.array([hoped * share]))
        hits[step] = body.holder.hits(moved, headings, gone).mean()
    stopped = np.flatnonzero(hits > hits[: STEPS // 4].min() + SLACK)
    return 1.0 if not len(stopped) else float(int(stopped[0]) / STEPS)


def single(candidates: Candidates, index: int) -> Candidates:
    """One of them, as candidates."""
    at = slice(index, index + 1)
    return Candidates(
        candidates.slides[at], candidates.axis[at], candidates.origin[at], candidates.source[at], candidates.radius[at]
    )


def nearest_to(axis: FloatArray, origin: FloatArray, point: FloatArray) -> FloatArray:
    """The point of a line nearest to another [m], shape [3]."""
    return np.asarray(origin + axis * float(axis @ (point - origin)))
