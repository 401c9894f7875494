"""Two joints open at once: one at its upper end while the other makes its whole way.

What two neighbours do to one another when only one of them is open is the single joints' business.
What they do when both are, a spread of poses may step over: here one stands open and the other is
followed continuously.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np

from ..config import PenetrationConfig
from ..description import FloatArray, JointLine
from ..geometry.solids import Solids
from .joint_sweep import JointCourse, Rest
from .pairs import Pairs
from .penetration_study import BothOpen, PairKind, PartPair

#: Intervals in which the room that a joint sweeps is boxed in before anything finer is asked.
BOXED_STEPS = 32


def open_neighbours(pairs: Pairs, rest: Rest, config: PenetrationConfig) -> tuple[BothOpen, ...]:
    """The worst depth by pair of joints and parts, one joint moving with the other at upper.

    Only joints that do not move the same part are asked, and only what the one moves against what
    the other does; what follows a joint moves with it. Pairs that stay apart are left out.
    """
    worst: dict[tuple[str, str, PartPair], BothOpen] = {}
    for joint, other in _near(pairs.solids, rest):
        only = frozenset(
            (min(a, b), max(a, b))
            for a in _parts(pairs.solids, joint)
            for b in _parts(pairs.solids, other)
        )
        values = {**rest.lower, other.name: rest.upper[other.name]}
        # A gap is nothing new here: it was measured where only one of the two is open, or does not
        # matter.
        found = JointCourse(
            joint, pairs, rest, replace(config, clearance_m=0.0), values, only
        ).run()
        for pair in found.pairs:
            first, second = sorted((joint.name, other.name))
            key = first, second, pair.parts
            if pair.contact.kind is PairKind.PLAIN and (
                key not in worst or pair.excess > worst[key].pair.excess
            ):
                worst[key] = BothOpen(joint.name, joint.kind, other.name, pair)
    return tuple(worst[key] for key in sorted(worst))


def _near(solids: Solids, rest: Rest) -> Iterator[tuple[JointLine, JointLine]]:
    """Ordered pairs of joints: the first's sweep comes near the open place of the second."""
    joints = [joint for joint in solids.tree.free if joint.name in rest.lower]
    swept = _swept(solids, rest, joints)
    for other in joints:
        solids.place({**rest.lower, other.name: rest.upper[other.name]})
        below = _below(solids, other)
        if not below:
            continue
        boxes = np.array([solids.items[index].collider.bounds for index in below])
        for joint in joints:
            if (
                joint.name in swept
                and _independent(solids, joint, other)
                and _meet(swept[joint.name], boxes)
            ):
                yield joint, other


def _swept(solids: Solids, rest: Rest, joints: list[JointLine]) -> Mapping[str, FloatArray]:
    """Boxes around everything below each joint, interval by interval from lower to upper [m]."""
    poses = solids.place(rest.lower)
    boxes: dict[str, FloatArray] = {}
    for joint in joints:
        places = np.linspace(0.0, rest.upper[joint.name] - rest.lower[joint.name], BOXED_STEPS + 1)
        stands, *groups = solids.groups(joint)
        found = []
        for group in groups:
            if group.solids:
                points = np.vstack(
                    [solids.items[index].collider.hull.vertices for index in group.solids]
                )
                path = solids.seen(group, stands, poses, float(places[-1]))
                found.append(path.orbit(points).swept_bounds(places))
        if found:
            boxes[joint.name] = np.vstack(found)
    return boxes


def _meet(swept: FloatArray, boxes: FloatArray) -> bool:
    low = swept[:, None, 0]
    high = swept[:, None, 1]
    return bool(((low < boxes[None, :, 1]) & (boxes[None, :, 0] < high)).all(axis=2).any())


def _below(solids: Solids, joint: JointLine) -> list[int]:
    return [index for group in solids.moved(joint) for index in group.solids]


def _parts(solids: Solids, joint: JointLine) -> frozenset[int]:
    return frozenset(part for group in solids.moved(joint) for part in group.parts)


def _independent(solids: Solids, one: JointLine, other: JointLine) -> bool:
    """Neither carries the other or anything that follows it."""
    return one is not other and not _parts(solids, one) & _parts(solids, other)
