"""Articulation and hulls -> the places where each joint is best opened."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import islice

import numpy as np

from ...articulation import Articulation, Joint
from ...asset import Hull, Target
from ...mesh import FloatArray
from .handles import find_handle
from .holds import Hold, HoldSearch, exposed, grasp, poke
from .poses import poses_of, pull_at, sampled
from .shape import PartShape, place, shape_of
from .surroundings import Surroundings, surroundings_of

#: Most targets of one joint.
MOST = 8
#: Points on what faces against the opening; how many of those that lie open are asked whether a
#: finger can push there; and how many of each where a grasp this good is at hand.
PLENTY = 96
POKES = 24
GOOD = 0.8
FEW = (32, 8)
#: A surface faces against the opening if the cosine between its normal and the motion is below
#: this.
AGAINST = -0.6
#: Targets of one kind nearer than this, to be reached from one side, are one [m].
APART_M = 0.025
ALIKE = 0.9
#: What is left of a place that nothing can hold: better than none.
HOPELESS = 0.05


def find_targets(articulation: Articulation, hulls: Sequence[Sequence[Hull]]) -> tuple[Target, ...]:
    """Where a robot may open each movable joint: tree order, best first, :data:`MOST` at most.

    Every movable joint that moves any geometry gets at least one; its score says what it is worth.

    Args:
        articulation: at rest, joint values 0.
        hulls: collision geometry of each part; empty ones where only the mesh is known.
    """
    everything = surroundings_of(articulation, hulls)
    targets: list[Target] = []
    for joint in articulation.movable_joints:
        part = held_part(articulation, joint)
        if part is not None:
            targets += _of_joint(articulation, joint, part, everything)
    return tuple(targets)


def held_part(articulation: Articulation, joint: Joint) -> int | None:
    """The first part with a surface that a joint moves: its child, or what a carrier carries."""
    carried = {joint.child}
    for other in articulation.joints[joint.child - 1 :]:
        if other.child in carried or other.parent in carried:
            carried.add(other.child)
            if len(shape_of(articulation, other.child).faces):
                return other.child
    return None


def _of_joint(
    articulation: Articulation, joint: Joint, part: int, everything: Surroundings
) -> list[Target]:
    shape = shape_of(articulation, part)
    task = HoldSearch(joint, shape, everything)
    holds = [hold for pose in poses_of(joint, shape) if (hold := grasp(task, pose)) is not None]
    plenty, most = FEW if any(hold.score >= GOOD for hold in holds) else (PLENTY, POKES)
    spots = zip(*sampled(joint, shape, AGAINST, plenty), strict=True)
    open_spots = ((point, normal) for point, normal in spots if exposed(task, point, normal))
    for point, normal in islice(open_spots, most):
        hold = poke(task, point, normal)
        if hold is not None:
            holds.append(hold)
    chosen = _distinct(holds) or [_last_resort(articulation, joint, part, shape)]
    return [
        Target(
            joint.name,
            part,
            h.kind,
            h.point,
            h.normal,
            h.pull,
            h.fingers,
            h.opening,
            round(h.score, 4),
        )
        for h in chosen
    ]


def _distinct(holds: list[Hold]) -> list[Hold]:
    """Return the best ones that are not nearly the same as a better one."""
    kept: list[Hold] = []
    for hold in sorted(holds, key=lambda hold: -round(hold.score, 4)):
        same = any(
            hold.kind == other.kind
            and float(np.linalg.norm(hold.point - other.point)) < APART_M
            and float(hold.normal @ other.normal) > ALIKE
            for other in kept
        )
        if not same:
            kept.append(hold)
    return kept[:MOST]


def _last_resort(articulation: Articulation, joint: Joint, part: int, shape: PartShape) -> Hold:
    """Where one would pull if possible: an unusable handle, the far edge, the middle of a front."""
    handle = find_handle(articulation, part)
    point, normal = (shape.center, joint.axis) if handle is None else (handle.point, handle.normal)
    pull = pull_at(joint, point)
    pull = pull if pull.any() else joint.axis
    kind = "push" if float(normal @ pull) < AGAINST else "hook"
    score = HOPELESS * float(place(joint, shape, point))
    return Hold(kind, point, normal, pull, _across(pull, normal), 0.0, score)


def _across(pull: FloatArray, normal: FloatArray) -> FloatArray:
    side = np.cross(pull, normal)
    if np.linalg.norm(side) < 0.1:
        side = np.cross(np.eye(3)[int(np.abs(normal).argmin())], normal)
    return np.asarray(side / np.linalg.norm(side))
