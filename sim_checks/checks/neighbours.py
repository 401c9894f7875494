"""Two joints open at once: one at its upper end while the other makes its whole way.

What two neighbours do to one another when only one of them is open is the single joints' business.
What they do when both are, a spread of poses may step over: here one stands open and the other is
followed continuously.
"""

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from ..config import PenetrationConfig
from ..description import FloatArray, JointLine
from ..geometry.solids import Solids
from .joint_sweep import JointCourse, Rest
from .pairs import Pairs
from .penetration_study import BothOpen, PairKind, PartPair

#: Intervals in which the room that a joint sweeps is boxed in before anything finer is asked.
BOXED_STEPS = 32


def open_neighbours(pairs: Pairs, rest: Rest, config: PenetrationConfig) -> tuple[BothOpen, ...]:
    """Return the worst depth by pair of joints and parts, one joint moving with the other at upper.

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
    """Yield ordered pairs of joints: the first's sweep comes near the second where that is open."""
    joints = [joint for joint in solids.tree.free if joint.name in rest.lower]
    independent = _independent(solids, joints)
    swept = _swept(solids, rest, [joints[i] for i in np.flatnonzero(independent.any(axis=1))])
    around = np.full((len(joints), 2, 3), np.nan)
    for index, joint in enumerate(joints):
        if joint.name in swept:
            around[index] = _around(swept[joint.name])
    for index, other in enumerate(joints):
        below = _below(solids, other)
        if not below or not independent[:, index].any():
            continue
        solids.place({**rest.lower, other.name: rest.upper[other.name]})
        boxes = np.array([solids.items[solid].collider.bounds for solid in below])
        # What is around all of it is compared first: most pairs of joints are far apart.
        low, high = _around(boxes)
        close = ((around[:, 0] < high) & (low < around[:, 1])).all(axis=1) & independent[:, index]
        for joint in (joints[i] for i in np.flatnonzero(close)):
            if _meet(swept[joint.name], boxes):
                yield joint, other


def _independent(solids: Solids, joints: list[JointLine]) -> npt.NDArray[np.bool_]:
    """Return which joints carry nothing that another moves, itself or by a follower; symmetric."""
    moves = np.zeros((len(joints), len(solids.tree.parts)), dtype=np.float32)
    for row, joint in enumerate(joints):
        moves[row, sorted(_parts(solids, joint))] = 1.0
    apart: npt.NDArray[np.bool_] = moves @ moves.T == 0.0
    np.fill_diagonal(apart, val=False)
    return apart


def _swept(solids: Solids, rest: Rest, joints: list[JointLine]) -> Mapping[str, FloatArray]:
    """Return boxes around all below each joint, by interval from lower to upper [m]."""
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


def _around(boxes: FloatArray) -> FloatArray:
    """Return the lowest and highest corner of boxes [m], shape [box_count, 2, 3] -> [2, 3]."""
    return np.array([boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)])


def _meet(swept: FloatArray, boxes: FloatArray) -> bool:
    low = swept[:, None, 0]
    high = swept[:, None, 1]
    return bool(((low < boxes[None, :, 1]) & (boxes[None, :, 0] < high)).all(axis=2).any())


def _below(solids: Solids, joint: JointLine) -> list[int]:
    return [index for group in solids.moved(joint) for index in group.solids]


def _parts(solids: Solids, joint: JointLine) -> frozenset[int]:
    return frozenset(part for group in solids.moved(joint) for part in group.parts)
