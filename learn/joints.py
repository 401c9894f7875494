"""How far joints are open, and which of them part a body from the one that holds it."""

from __future__ import annotations

import numpy as np

from asset_factory.factory.articulation import Articulation, Joint, JointKind


def value_at(joint: Joint, share: float) -> float:
    """Return the joint value with a share of the range opened [rad] or [m].

    A joint without ends has no closed one: it starts where it is, and all its range is half a turn.
    """
    if joint.kind is JointKind.CONTINUOUS:
        return share * np.pi
    return joint.lower + share * joint.range


def way_down(articulation: Articulation, part: int) -> tuple[int, tuple[Joint, ...]]:
    """Return the next part with faces towards the root, or the root, and movable joints to it."""
    found: list[Joint] = []
    while (joint := articulation.parent_joint(part)) is not None:
        if joint.movable:
            found.insert(0, joint)
        part = joint.parent
        if len(articulation.parts[part].faces):
            break
    return part, tuple(found)
