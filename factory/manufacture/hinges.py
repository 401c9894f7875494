"""Hinges at the edges of a door.

About the front one inset doors pass their frame, about the back one doors before it half round.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ..articulation import Articulation, Joint, JointKind
from ..mesh import FloatArray
from .poses import arms_from

#: What is so near to the hinge's edge, of the door's width, is looked at for where it begins.
EDGE = 0.1
#: Hinges that lie this close to that edge are there already [m].
THERE_M = 0.0005
#: Directions are alike to this cosine: a handle before a door turns what is taken for its plane.
ALIKE = 0.9
#: And at right angles to this one.
ACROSS = 0.02
#: Axes this near to a principal direction may have been meant to lie along it [cosine of 12 deg];
STRAIGHT = float(np.cos(np.radians(12.0)))
#: and nearer than this they do [cosine of a tenth of a degree].
STRAIGHT_ALREADY = float(np.cos(np.radians(0.1)))
#: What is off by less than this is as straight as people annotate [cosine of 3 degrees].
CROOKED = float(np.cos(np.radians(3.0)))


def is_askew(axis: FloatArray, straight: float = STRAIGHT_ALREADY) -> bool:
    """Return whether a unit axis is a little off a principal direction, and not ``straight``."""
    return STRAIGHT <= float(np.abs(axis).max()) < straight


def at_front_edge(articulation: Articulation, joint: Joint) -> Joint | None:
    """Return the same hinge at the outermost edge of its part, on the side where it is.

    About that edge every point of a flat door moves away from the parts beside and behind it.
    ``None`` where the joint is no hinge that opens one way, or is there already.
    """
    return _at_edge(articulation, joint, np.max)


def at_back_edge(articulation: Articulation, joint: Joint) -> Joint | None:
    """Return the same hinge at the edge towards what the door lies before."""
    return _at_edge(articulation, joint, np.min)


def _at_edge(
    articulation: Articulation, joint: Joint, extreme: Callable[[FloatArray], np.float64]
) -> Joint | None:
    """Return the same hinge where its part begins: where it stands out least or most there."""
    turn = joint.upper + joint.lower
    faces = articulation.parts[joint.child].faces
    if joint.kind is not JointKind.REVOLUTE or turn == 0.0 or not len(faces):
        return None
    part = articulation.part_mesh(joint.child)
    (arm,) = arms_from(joint, part.bounds.mean(axis=0, keepdims=True))
    outward = _along_axis(np.cross(joint.axis, arm) * np.sign(turn))
    if outward is None or abs(float(outward @ joint.axis)) > ACROSS:
        return None
    toward = np.cross(outward, joint.axis)
    toward = toward * -np.sign(float(toward @ arm))
    reach = part.vertices @ toward
    near = reach >= reach.max() - EDGE * float(np.ptp(reach))
    face = float(extreme(part.vertices[near] @ outward))
    off = toward * (float(reach.max()) - float(joint.origin @ toward))
    off = off + outward * (face - float(joint.origin @ outward))
    if float(np.linalg.norm(off)) <= THERE_M:
        return None
    return replace(joint, origin=joint.origin + off)


def _along_axis(direction: FloatArray) -> FloatArray | None:
    """Return the axis of the object frame that a direction goes along, if it does."""
    length = float(np.linalg.norm(direction))
    longest = int(np.abs(direction).argmax())
    if abs(float(direction[longest])) <= ALIKE * length:
        return None
    return np.asarray(np.eye(3)[longest] * np.sign(direction[longest]))
