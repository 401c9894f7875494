"""A drawer's front and its box, where two proposers found one each: they are one part."""

from __future__ import annotations

import numpy as np

from ...articulation import Articulation, Joint, JointKind
from ...geometry.welding import welded
from ...models.detector.decode import shared_areas
from ...part import PartKind

#: Two slide one way if the cosine between their axes is at least this, and are in line if they
#: share this much of the smaller one's outline. A part of more than so many times a drawer's
#: outline is no front of it.
ALONG = 0.97
IN_LINE = 0.8
LARGER = 2.0


def with_whole_drawers(articulation: Articulation) -> Articulation:
    """Return an articulation in which what slides in line with a drawer is part of it."""
    kinds = {joint.child: articulation.parts[joint.child].kind for joint in articulation.joints}
    carrying = {joint.parent for joint in articulation.joints}
    drawers = [j for j in articulation.joints if kinds[j.child] is PartKind.DRAWER]
    loose = [
        j
        for j in articulation.joints
        if kinds[j.child] is PartKind.PART and j.child not in carrying
    ]
    # Of several drawers the first one counts.
    onto = {
        joint.name: drawer.child
        for drawer in reversed(drawers)
        for joint in loose
        if _slides_along(joint, drawer) and _is_in_line(articulation, joint, drawer)
    }
    return welded(articulation, (), onto) if onto else articulation


def _slides_along(joint: Joint, drawer: Joint) -> bool:
    """Tell whether a part slides as a drawer does that holds it, or hangs on the same part."""
    along = joint.kind is JointKind.PRISMATIC and abs(float(joint.axis @ drawer.axis)) >= ALONG
    return along and joint.parent in (drawer.parent, drawer.child)


def _is_in_line(articulation: Articulation, joint: Joint, drawer: Joint) -> bool:
    """Tell whether a part covers a drawer, or is covered by it, seen along the drawer's way."""
    across = np.abs(drawer.axis) < np.abs(drawer.axis).max()
    part, whole = (
        articulation.part_mesh(j.child).bounds[:, across].ravel() for j in (joint, drawer)
    )
    own, shared = shared_areas(part, np.stack([part, whole]))
    (size,) = shared_areas(whole, whole[None])
    return bool(own <= LARGER * size and shared >= IN_LINE * min(own, size))
