"""A drawer's front and its box, where two proposers found one each: they are one part."""

from __future__ import annotations

import numpy as np

from ...articulation import Articulation, Joint, JointKind
from ...mesh import FloatArray
from ...part import PartKind
from ..pruning import keep_parts

#: Two slide one way if the cosine between their axes is at least this, and are in line if they
#: share this much of the smaller one's outline. A part of more than so many times a drawer's
#: outline is no front of it.
ALONG = 0.97
IN_LINE = 0.8
LARGER = 2.0


def with_whole_drawers(articulation: Articulation) -> Articulation:
    """Return an articulation in which what slides in line with a drawer is part of it."""
    drawers = [
        joint
        for joint in articulation.joints
        if articulation.parts[joint.child].kind is PartKind.DRAWER
    ]
    carrying = {joint.parent for joint in articulation.joints}
    into: dict[int, int] = {}
    for joint in articulation.joints:
        if articulation.parts[joint.child].kind is PartKind.PART and joint.child not in carrying:
            for drawer in drawers:
                if _is_of(articulation, joint, drawer):
                    into.setdefault(joint.child, drawer.child)
    kept = {joint.child for joint in articulation.joints} - into.keys()
    return keep_parts(articulation, kept, into=into) if into else articulation


def _is_of(articulation: Articulation, joint: Joint, drawer: Joint) -> bool:
    """Tell whether a part slides with a drawer and covers it, or is covered, along its way."""
    along = joint.kind is JointKind.PRISMATIC and abs(float(joint.axis @ drawer.axis)) >= ALONG
    if not along or joint.parent not in (drawer.parent, drawer.child):
        return False
    across = np.abs(drawer.axis) < np.abs(drawer.axis).max()
    one, other = (articulation.part_mesh(j.child).bounds[:, across] for j in (joint, drawer))
    shared = np.minimum(one[1], other[1]) - np.maximum(one[0], other[0])
    part = _area(one[1] - one[0])
    whole = _area(other[1] - other[0])
    return part <= LARGER * whole and _area(shared) >= IN_LINE * min(part, whole)


def _area(sides: FloatArray) -> float:
    return float(np.prod(np.maximum(sides, 0.0)))
