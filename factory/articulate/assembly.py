"""Proposals -> Articulation."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from types import MappingProxyType

import numpy as np

from ..articulation import Articulation, Joint, JointKind, Part
from ..mesh import IntArray, Mesh
from ..part import PartKind
from .proposal import Proposal

#: What follows a part's name in its joint's.
JOINT_SUFFIX: Mapping[JointKind, str] = MappingProxyType(
    {
        JointKind.PRISMATIC: "slide",
        JointKind.REVOLUTE: "hinge",
        JointKind.CONTINUOUS: "turn",
    }
)


def assembled(
    mesh: Mesh,
    face_part: IntArray,
    proposals: Sequence[Proposal],
    articulator: str,
    hosts: Sequence[int] = (),
) -> Articulation:
    """Return the articulation in which all of some proposals come true.

    Args:
        mesh: metres, z up.
        face_part: of every face: 0 for the body, else 1 + index of the proposal that it belongs
            to, shape [face_count].
        proposals: of moving parts.
        articulator: who says so.
        hosts: for each proposal what it hangs on: 0 for the body, else 1 + index of another one;
            all hang on the body by default.
    """
    held = tuple(hosts) or (0,) * len(proposals)
    place = {0: 0}
    parts = [Part("base", np.flatnonzero(face_part == 0), kind=PartKind.BODY)]
    joints: list[Joint] = []
    notes: list[str] = []

    def depth(number: int) -> int:
        return 0 if number == 0 else 1 + depth(held[number - 1])

    order = sorted(range(1, len(held) + 1), key=depth)
    names = _names([proposals[number - 1] for number in order])
    for number, name in zip(order, names, strict=True):
        proposal = proposals[number - 1]
        if proposal.slide is not None:
            parts.append(Part(f"{name}_carrier", np.zeros(0, np.int64), proposal.existence))
        place[number] = len(parts)
        parts.append(
            Part(
                name,
                np.flatnonzero(face_part == number),
                proposal.existence,
                kind=proposal.kind,
                panel=proposal.panel,
                source=proposal.source,
            )
        )
        joints += _joints(name, proposal, place[held[number - 1]], place[number])
        notes += [f"{name} {note}" for note in proposal.notes]
    return Articulation(mesh, tuple(parts), tuple(joints), articulator, tuple(notes))


def _joints(name: str, proposal: Proposal, holder: int, part: int) -> Iterator[Joint]:
    """Yield one joint; two for a part that turns and slides: it slides in a carrier that turns."""
    motions = [proposal.motion] if proposal.slide is None else [proposal.motion, proposal.slide]
    parent = holder
    for child, motion in enumerate(motions, start=part + 1 - len(motions)):
        yield Joint(
            name=f"{name}_{JOINT_SUFFIX[motion.kind]}",
            kind=motion.kind,
            parent=parent,
            child=child,
            axis=motion.axis,
            origin=proposal.motion.origin,
            lower=motion.lower,
            upper=motion.upper,
            confidence=proposal.probability,
        )
        parent = child


def _names(proposals: Sequence[Proposal]) -> list[str]:
    """Return the parts' names: as stated, else kinds with numbers that make no stated name.

    For example ``door_0``, ``door_1``, ``lid_0``.
    """
    stated = {proposal.name for proposal in proposals}
    count: Counter[str] = Counter()
    names = []
    for proposal in proposals:
        name = proposal.name
        while name is None or (proposal.name is None and name in stated):
            name = f"{proposal.kind}_{count[proposal.kind]}"
            count[proposal.kind] += 1
        names.append(name)
    return names
