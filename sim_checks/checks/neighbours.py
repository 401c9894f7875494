"""Two joints open at once: one at its upper end while the other makes its whole way.

What two neighbours do to one another when only one of them is open is the single joints' business. What they do when
both are, a spread of poses may step over: here one stands open and the other is followed continuously.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np

from ..config import PenetrationConfig
from ..description import FloatArray, JointLine
from ..solids import Solids
from .joint_sweep import Course, Rest
from .pairs import Pairs
from .penetration_report import BothOpen, PairKind, PartPair

#: Intervals in which the room that a joint sweeps is boxed in before anything finer is asked.
BOXED_STEPS = 32


def open_neighbours(pairs: Pairs, rest: Rest, config: PenetrationConfig) -> tuple[BothOpen, ...]:
    """For two joints and two parts, the deepest either joint drives them while the other is at upper.

    Only joints that do not carry one another are asked, neither leads the other, and only what hangs below the one
    against what hangs below the other. Pairs that stay apart are left out.
    """
    worst: dict[tuple[str, str, PartPair], BothOpen] = {}
    for joint, other in _near(pairs.solids, rest):
        only = frozenset(
            (min(a, b), max(a, b)) for a in _parts(pairs.solids, joint) for b in _parts(pairs.solids, other)
        )
        values = {**rest.lower, other.name: rest.upper[other.name]}
        # A gap is nothing new here: it was measured where only one of the two is open, or does not matter.
        found = Course(joint, pairs, rest, replace(config, clearance_m=0.0), values, only).run()
        for pair in found.pairs:
            first, second = sorted((joint.name, other.name))
            key = first, second, pair.parts
            if pair.contact.kind is PairKind.PLAIN and (key not in worst or pair.excess > worst[key].pair.excess):
                worst[key] = BothOpen(joint.name, joint.kind, other.name, pair)
    return tuple(worst[key] for key in sorted(worst))


def _near(solids: Solids, rest: Rest) -> Iterator[tuple[JointLine, JointLine]]:
    """Ordered pairs of joints: what the first sweeps comes to where the second stands when it is open."""
    joints = [joint for joint in solids.tree.moving if joint.name in rest.lower]
    swept = _swept(solids, rest, joints)
    for other in joints:
        solids.place({**rest.lower, other.name: rest.upper[other.name]})
        below = _below(solids, other)
        if not below:
            continue
        boxes = np.array([solids.items[index].collider.bounds for index in below])
        for joint in joints:
            if joint.name in swept and _independent(solids, joint, other) and _meet(swept[joint.name], boxes):
                yield joint, other


def _swept(solids: Solids, rest: Rest, joints: list[JointLine]) -> Mapping[str, FloatArray]:
    """Boxes around everything below each joint, interval by interval from lower to upper [m]."""
    poses = solids.place(rest.lower)
    boxes: dict[str, FloatArray] = {}
    for joint in joints:
        below = _below(solids, joint)
        if below:
            path = solids.path(joint, poses, rest.upper[joint.name] - rest.lower[joint.name])
            points = np.vstack([solids.items[index].collider.hull.vertices for index in below])
            boxes[joint.name] = path.orbit(points).swept_bounds(np.linspace(0.0, path.length, BOXED_STEPS + 1))
    return boxes


def _meet(swept: FloatArray, boxes: FloatArray) -> bool:
    low, high = swept[:, None, 0], swept[:, None, 1]
    return bool(((low < boxes[None, :, 1]) & (boxes[None, :, 0] < high)).all(axis=2).any())


def _below(solids: Solids, joint: JointLine) -> list[int]:
    links = solids.tree.below(joint)
    return [index for index, item in enumerate(solids.items) if item.link in links]


def _parts(solids: Solids, joint: JointLine) -> frozenset[int]:
    part_of = solids.tree.part_of()
    return frozenset(part_of[name] for name in solids.tree.below(joint))


def _independent(solids: Solids, one: JointLine, other: JointLine) -> bool:
    """Neither carries the other, and no third drives or follows both."""
    if one.child in solids.tree.below(other) or other.child in solids.tree.below(one):
        return False
    leaders = [joint.name if joint.mimic is None else joint.mimic.leader for joint in (one, other)]
    return leaders[0] != leaders[1]
