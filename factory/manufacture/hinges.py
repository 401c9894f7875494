"""Hinges at the edges of a door.

About the front one inset doors pass their frame, about the back one doors before it half round.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ..articulation import Articulation, Joint, JointKind
from ..mesh import FloatArray
from ..part import OpensBy, Panel

#: What is so near to the hinge's edge, of the door's width, is looked at for where it begins.
EDGE = 0.1
#: Hinges that lie this close to that edge are there already [m].
THERE_M = 0.0005
#: Directions at right angles are so to this cosine.
ACROSS = 0.02
#: Axes this near to a principal direction may have been meant to lie along it [cosine of 12 deg];
STRAIGHT = float(np.cos(np.radians(12.0)))
#: and nearer than this they do [cosine of a tenth of a degree].
STRAIGHT_ALREADY = float(np.cos(np.radians(0.1)))
#: What is off by less than this is as straight as people annotate [cosine of 3 degrees].
CROOKED = float(np.cos(np.radians(3.0)))


def is_askew(axis: FloatArray) -> bool:
    """Return whether a unit axis is a little off a principal direction of the object frame."""
    return STRAIGHT <= float(np.abs(axis).max()) < STRAIGHT_ALREADY


def is_crooked(axis: FloatArray) -> bool:
    """Return whether a unit axis is further off a principal direction than careless annotations."""
    return is_askew(axis) and float(np.abs(axis).max()) < CROOKED


def at_front_edge(articulation: Articulation, joint: Joint) -> Joint | None:
    """Return the same hinge at the outermost edge of its part, on the side where it is.

    About that edge every point of a flat door moves away from what is beside and behind it.

    Args:
        articulation: over the mesh at rest [m].
        joint: of it.

    Returns:
        ``None`` where the joint is no hinge of a panel that opens one way, or is there already.
    """
    return _at_edge(articulation, joint, np.max)


def at_back_edge(articulation: Articulation, joint: Joint) -> Joint | None:
    """Return the same hinge at the edge towards what the door lies before."""
    return _at_edge(articulation, joint, np.min)


def _toward_hinge(panel: Panel) -> FloatArray:
    """Return the direction from a panel's middle to the edge where it is hinged, shape [3]."""
    right, up, away = panel.frame
    ways = {OpensBy.LEFT: -right, OpensBy.RIGHT: right, OpensBy.BOTTOM: -up, OpensBy.TOP: up}
    return np.asarray(ways.get(panel.opens, away))


def _at_edge(
    articulation: Articulation, joint: Joint, extreme: Callable[[FloatArray], np.float64]
) -> Joint | None:
    """Return the same hinge where its panel begins, or ends, at the hinge's edge."""
    part = articulation.parts[joint.child]
    opens_one_way = joint.kind is JointKind.REVOLUTE and joint.upper + joint.lower != 0.0
    if not opens_one_way or part.panel is None or not len(part.faces):
        return None
    outward = part.panel.outward
    toward = _toward_hinge(part.panel)
    if max(abs(float(way @ joint.axis)) for way in (outward, toward)) > ACROSS:
        return None
    points = articulation.mesh.vertices[np.unique(articulation.mesh.faces[part.faces])]
    reach = points @ toward
    near = reach >= reach.max() - EDGE * float(np.ptp(reach))
    face = float(extreme(points[near] @ outward))
    off = toward * (float(reach.max()) - float(joint.origin @ toward))
    off = off + outward * (face - float(joint.origin @ outward))
    if float(np.linalg.norm(off)) <= THERE_M:
        return None
    return replace(joint, origin=joint.origin + off)
