"""Articulation and hulls -> the places where each joint is best opened."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import islice

import numpy as np

from ...articulation import Articulation
from ...asset import Hull, Target
from ..hinges import ALIKE
from .handles import handle_of
from .holds import HoldSearch, exposed, grasp, hand_axes, poke
from .poses import AGAINST, find_poses, spread_against
from .shape import Moving, shape_of
from .surroundings import surroundings_of

#: Most targets of one joint.
MOST = 8
#: Points on what faces against the opening; how many of those that lie open are asked whether a
#: finger can push there; and how many of each where a grasp this good is at hand.
PLENTY = (96, 24)
GOOD = 0.8
FEW = (32, 8)
#: Targets of one kind nearer than this, to be reached from one side, are one [m].
APART_M = 0.025
#: What is left of a place that nothing can hold: better than none.
HOPELESS = 0.05


def find_targets(articulation: Articulation, hulls: Sequence[Sequence[Hull]]) -> tuple[Target, ...]:
    """Find where a robot may open each movable joint: tree order, best first, few of each.

    Every movable joint that moves any geometry gets at least one; its score says what it is worth.
    Of a part without hulls only the mesh is known.
    """
    everything = surroundings_of(articulation, hulls)
    targets: list[Target] = []
    for joint in articulation.movable_joints:
        shapes = (shape_of(articulation, part) for part in articulation.carried(joint.child))
        # What is held is the joint's child, or the first part with a surface that it carries.
        shape = next((shape for shape in shapes if len(shape.faces)), None)
        if shape is not None:
            moving = Moving(joint, shape)
            holds = _holds(HoldSearch(moving, everything))
            chosen = _distinct(holds) or [_last_resort(moving)]
            targets += [replace(each, score=round(each.score, 4)) for each in chosen]
    return tuple(targets)


def _holds(task: HoldSearch) -> list[Target]:
    """Try every candidate: poses to grasp at, and points to push at or hook behind."""
    poses = find_poses(task.moving)
    holds = [hold for pose in poses if (hold := grasp(task, pose)) is not None]
    plenty, most = FEW if any(hold.score >= GOOD for hold in holds) else PLENTY
    spots = zip(*spread_against(task.moving, plenty), strict=True)
    open_spots = (spot for spot in spots if exposed(task, *spot))
    pokes = (poke(task, *spot) for spot in islice(open_spots, most))
    return [*holds, *(hold for hold in pokes if hold is not None)]


def _distinct(holds: list[Target]) -> list[Target]:
    """Return the best ones that are not nearly the same as a better one."""
    kept: list[Target] = []
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


def _last_resort(moving: Moving) -> Target:
    """Name where one would pull if one could: a handle, the far edge, the middle of a front."""
    handle = handle_of(moving)
    normal = handle.normal
    pull = handle.pull
    kind = "push" if float(normal @ pull) < AGAINST else "hook"
    fingers = hand_axes(moving.joint, normal)[0]
    score = HOPELESS * float(moving.place(handle.point))
    held = (moving.joint.name, moving.shape.part)
    return Target(*held, kind, handle.point, normal, pull, fingers, 0.0, score)
