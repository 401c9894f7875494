"""Knobs, buttons and wheels, and the room that what holds them keeps free for them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...articulation import Joint, JointKind
from ...asset import Hull
from ...mesh import BoolArray, FloatArray
from ..decompose.convex import depth_below, hull_of
from ..poses import moved
from ..separate.clip import carved, clipped, meeting
from .box import Box
from .bump import Bump
from .sweep import CLEAR_M, entered, motions
from .work import Workpiece

#: Thickness of the layer of cells at the foot of a knob [m].
LAYER_M = 0.006
#: Poses along the way of a button.
PRESSES = 8
#: A piece of which one plane leaves this share is not worth several.
WELL_LEFT = 0.98
#: What slides into a panel may take this much of it.
PANEL_LEFT = 0.9


def planes_of_bumps(bumps: dict[int, Bump], joints: list[Joint]) -> Iterator[tuple[int, float]]:
    """Yield the axes that planes lie across for rooms to end by knobs, and where [m]."""
    for part, bump in bumps.items():
        room = Box.around(_passed(bump.hull, joints[part - 1])).grown(CLEAR_M)
        ends = np.stack([room.low, room.high], axis=1).tolist()
        if bump.normal is not None:
            # Pieces that end a little too high are seen to enter a thin layer at its foot; a
            # thin one below would be a foil of its own.
            across = int(np.abs(bump.normal).argmax())
            side = float(np.sign(bump.normal[across]))
            foot = [bump.base * side, (bump.base + LAYER_M) * side]
            ends[across] = foot + [end for end in ends[across] if abs(end - foot[0]) > LAYER_M]
        for axis in range(3):
            yield from ((axis, end) for end in ends[axis])


def make_bumps(work: Workpiece) -> None:
    """Make knobs, buttons and wheels, one hull each, with room in what holds them."""
    for part, bump in work.bumps.items():
        work.hulls[part] = (bump.hull,)
        host = work.host(part)
        inside = entered(work.lattice, [bump.hull], _way(work.joints[part - 1]), CLEAR_M)
        work.clear_way(host, inside)


def _way(joint: Joint) -> list[FloatArray]:
    """Return where a knob or a button is, at rest and as it is pressed; it turns on the spot."""
    slides = joint.kind is JointKind.PRISMATIC
    return [np.eye(4), *motions(joint, PRESSES)] if slides else [np.eye(4)]


def _passed(hull: Hull, joint: Joint) -> FloatArray:
    """Return a hull's corners all along its way [m], shape [n, 3]."""
    return np.concatenate([moved(hull.vertices, pose) for pose in _way(joint)])


def clear_of_bumps(work: Workpiece, host: int, points: FloatArray) -> BoolArray:
    """Return which points of a host's surface [m] lie clear of the ways of its knobs, shape [n]."""
    clear = np.ones(len(points), dtype=bool)
    for part, bump in work.bumps.items():
        if work.host(part) != host:
            continue
        for pose in _way(work.joints[part - 1]):
            clear &= depth_below(bump.hull, (points - pose[:3, 3]) @ pose[:3, :3]) < -CLEAR_M
    return clear


def keep_clear(work: Workpiece, host: int) -> None:
    """Cut the pieces of what holds knobs where these pass; the knobs stay whole."""
    for part, bump in work.bumps.items():
        if work.host(part) == host:
            passed = _passed(bump.hull, work.joints[part - 1])
            work.hulls[host] = _all_around(work.hulls.get(host, ()), passed)


def give_way(work: Workpiece, part: int) -> None:
    """Cut the panel on which something else slides, where that takes little of it."""
    joint = work.joints[part - 1]
    host = work.host(part)
    if host not in work.panels or joint.kind is not JointKind.PRISMATIC:
        return
    before = work.hulls.get(host, ())
    after = before
    for hull in work.hulls[part]:
        after = _all_around(after, _passed(hull, joint))
    left = sum(hull.volume for hull in after)
    if left >= PANEL_LEFT * sum(hull.volume for hull in before):
        work.hulls[host] = after


def _all_around(hulls: tuple[Hull, ...], passed: FloatArray) -> tuple[Hull, ...]:
    return tuple(piece for hull in hulls for piece in _around(hull, passed))


def _around(hull: Hull, passed: FloatArray) -> list[Hull]:
    """Cut a hull by one plane where that takes little, else into several pieces."""
    room = hull_of(passed)
    met = None if room is None else meeting(hull, room, np.eye(4))
    if met is None or met.depth <= -CLEAR_M:
        return [hull]
    cuts = [
        clipped(hull, direction, float(start) - CLEAR_M)
        for direction, start in zip(met.directions, met.second_starts, strict=True)
    ]
    best = max((cut for cut in cuts if cut), key=lambda cut: cut.volume, default=None)
    if best is not None and best.volume >= WELL_LEFT * hull.volume:
        return [best]
    pieces = carved(hull, passed, CLEAR_M)
    if best is not None and sum(piece.volume for piece in pieces) < best.volume:
        return [best]
    return pieces
