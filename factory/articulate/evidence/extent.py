"""How far a part goes: as far as it is said to, and no further than the way is free."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...articulation import JointKind
from ...mesh import FloatArray
from ..geometric.movers import DOOR_LIMIT
from .body import Body
from .candidates import Candidates
from .guess import Guess
from .travel import displaced

#: Where nobody says how far, what slides goes by this share of its way.
USUAL_SLIDE = 0.7
#: Nothing slides farther than this share of its way, whoever says so.
FARTHEST_SLIDE = 1.5
#: A turn that is said to go this far round has no end [rad].
ROUND = 0.95 * 2.0 * np.pi
#: No range is shorter than this share of what was hoped for: what meets something at once was seen
#: wrongly.
LEAST = 0.25
#: What slides and is smaller than this share of the object is a button rather than a drawer.
SMALL = 0.07
#: A part shorter than this share of the object, as seen along its way, is a front: it goes as deep
#: as the object.
FRONT = 0.15
#: A way, or half a turn, has so many steps: a network's last digits are the processor's. Among the
#: first the part comes free of what it touches at rest.
STEPS = 36
AT_REST = 5
#: Share of the points that may meet something on the way in all: a wrong label is not yet a wall.
SLACK = 0.1
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


def extent_of(body: Body, chosen: Candidates, guess: Guess) -> Extent:
    """Return the limits of one candidate.

    Args:
        body: the part.
        chosen: exactly one candidate.
        guess: whose ``upper`` is believed, if it speaks of the same kind.
    """
    slides = bool(chosen.slides[0])
    axis = chosen.axis[0]
    said = guess.upper if guess.turns is None or (guess.turns < 0.5) == slides else None
    hoped = _slide(body, axis, said) if slides else _turn(said)
    if not slides and hoped >= ROUND:
        return Extent(JointKind.CONTINUOUS, -np.pi, np.pi, 1.0)
    out = stands_out_by(body, axis) if slides and not is_small(body) else 0.0
    if out > OPEN * hoped:
        # Who sees it open guesses the rest of its range.
        left = max(_slide(body, axis, None) - out, 0.0)
        return Extent(JointKind.PRISMATIC, -out, left * free_way(body, chosen, left), 1.0)
    share = free_way(body, chosen, hoped)
    kind = JointKind.PRISMATIC if slides else JointKind.REVOLUTE
    return Extent(kind, 0.0, hoped * max(share, LEAST), share)


def _slide(body: Body, axis: FloatArray, said: float | None) -> float:
    """Return how far a part should slide [m], as somebody says or as usual."""
    way = _way(body, axis)
    if not said:
        return USUAL_SLIDE * way
    return min(max(round(STEPS * said / way), 1) / STEPS, FARTHEST_SLIDE) * way


def _turn(said: float | None) -> float:
    """Return how far a part should turn [rad], as somebody says or as usual."""
    if not said:
        return float(DOOR_LIMIT)
    return max(round(STEPS * said / np.pi), 1) * np.pi / STEPS


def is_small(body: Body) -> bool:
    """Tell whether a part is as small as a button."""
    return body.diagonal < SMALL * body.partition.mesh.diagonal


def free_way(body: Body, chosen: Candidates, farthest: float) -> float:
    """Return the share of the way before more than a few points meet the part's holder."""
    values = np.arange(1, STEPS + 1) / STEPS * farthest
    tried = chosen.at(np.zeros(STEPS, dtype=np.int64))
    hits = body.holder.hits(*displaced(tried, body.probes.points, values))
    free = int(np.argmin(hits[:AT_REST].mean(axis=1)))
    met = np.logical_or.accumulate(hits[free:] & ~hits[free], axis=0).mean(axis=1)
    stopped = free + np.flatnonzero(met > SLACK)
    return float(stopped[0] / STEPS) if len(stopped) else 1.0


def stands_out_by(body: Body, axis: FloatArray) -> float:
    """Return how far the front of a part inside its holder stands out of it along a level axis [m].

    Not negative. A handle is not the front, however far it stands out.
    """
    if abs(float(axis[2])) > LEVEL or not len(body.held):
        return 0.0
    mouth = float((body.held.points @ axis).max())
    inside = mouth - float((body.corners @ axis).min())
    return max(_front(body, axis) - mouth, 0.0) if inside > INSIDE * body.diagonal else 0.0


def _way(body: Body, axis: FloatArray) -> float:
    """Return the part's length along its way; of drawer fronts without a box, the object's [m]."""
    length = max(float(np.ptp(body.probes.points @ axis)), 1e-9)
    whole = max(float(np.ptp(body.partition.few_vertices @ axis)), 1e-9)
    return whole if length < FRONT * whole and not is_small(body) else length


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
