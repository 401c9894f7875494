"""The closed pose of hinges whose parts stand open in the mesh."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree

from ..articulation import Articulation, Joint, JointKind
from ..geometry.posing import face_parts
from ..mesh import FloatArray
from ..part import PartKind
from .evidence.body import Body, Partition, body_of
from .evidence.candidates import Candidates, LineSource
from .evidence.extent import free_way
from .geometric.scene import level_frame
from .ranges import OPEN_DIFFERENCE, box_volumes

#: Kinds of part that close something.
CLOSING = frozenset({PartKind.PART, PartKind.DOOR, PartKind.FLAP, PartKind.LID})
#: Poses are this far apart, and no part stands open by more [rad].
STEP = np.radians(3.0)
MOST = np.radians(177.0)
#: A closed part is nearly square to its holder: elsewhere its handle would turn inward [rad].
SQUARE = np.radians(12.0)
#: A box this much larger than the smallest is as small: handles and thickness go on turning in.
AS_SMALL = 0.04
#: So much more of a part's surface is near what holds it once it is closed.
NEARER = 0.15
#: Surface nearer than this share of the object's diagonal is near.
NEAR_BY = 0.04


def with_closed_hinges(articulation: Articulation) -> Articulation:
    """Return an articulation in which hinges whose parts stand open may be closed.

    A part stands open if turning it back, as far as nothing is in its way, makes the box around it
    and what holds it much smaller and brings it near its holder. Its lower limit becomes the first
    such pose in which it is square to its holder.

    Args:
        articulation: of a mesh whose sides look along the axes.
    """
    partition = Partition(
        articulation.mesh,
        face_parts(articulation),
        np.array([-1, *(joint.parent for joint in articulation.joints)]),
    )
    joints = tuple(_closed(articulation, partition, joint) for joint in articulation.joints)
    notes = tuple(
        note_open(repr(articulation.parts[after.child].name), np.degrees(-after.lower))
        for before, after in zip(articulation.joints, joints, strict=True)
        if after is not before
    )
    return replace(articulation, joints=joints, notes=(*articulation.notes, *notes))


def note_open(what: str, degrees: float) -> str:
    """Return a sentence about a part that stands open."""
    return f"{what} stands open by {degrees:.0f} degrees in the mesh: its joint closes it"


def _closed(articulation: Articulation, partition: Partition, joint: Joint) -> Joint:
    """Return a joint whose lower limit is its closed pose; the same where that is as drawn."""
    kind = articulation.parts[joint.child].kind
    if joint.kind is not JointKind.REVOLUTE or kind not in CLOSING or joint.lower < 0.0:
        return joint
    body = body_of(partition, joint.child)
    if body is None:
        return joint
    smallest = _smallest(articulation, body, joint)
    angle = None if smallest is None else _squared(body, joint, smallest)
    if angle is None or _near(body, joint, angle) < _near(body, joint, 0.0) + NEARER:
        return joint
    axis = -joint.axis if angle > 0.0 else joint.axis
    opened = abs(angle)
    return replace(joint, axis=axis, lower=-opened, upper=max(joint.range - opened, 0.0))


def _smallest(articulation: Articulation, body: Body, joint: Joint) -> float | None:
    """Return the first joint value [rad] at which part and holder fill much the smallest box.

    ``None`` where no way that is free leads there.
    """
    owner = body.partition.face_part
    inside = np.isin(owner, articulation.carried(joint.child))
    both = inside | (owner == joint.parent)
    mesh = articulation.mesh.submesh(np.flatnonzero(both))
    moved = inside[both]
    best = (1.0 - OPEN_DIFFERENCE) * float(box_volumes(mesh, moved, joint, [0.0])[0])
    found = None
    for sign in (-1.0, 1.0):
        steps = np.arange(1, round(_free(body, joint, sign) / STEP) + 1) * STEP * sign
        volumes = box_volumes(mesh, moved, joint, np.append(steps, 0.0))
        if volumes.min() < best:
            best = float(volumes.min())
            first = int(np.argmax(volumes <= (1.0 + AS_SMALL) * best))
            found = float(steps[first])
    return found


def _free(body: Body, joint: Joint, sign: float) -> float:
    """Return how far a part turns about its hinge before its holder stops it [rad]."""
    turn = Candidates(
        np.array([False]),
        sign * joint.axis[None],
        joint.origin[None],
        np.array([LineSource.GUESSED]),
        np.zeros(1),
    )
    return float(MOST * free_way(body, turn, MOST))


def _squared(body: Body, joint: Joint, angle: float) -> float | None:
    """Return the joint value [rad] near ``angle`` at which a part is square to its holder."""
    partition = body.partition
    holder = level_frame(partition.triangles[partition.face_part == joint.parent])
    start, end = (_across(frame, joint.axis) for frame in (body.frames[-1], holder))
    turn = float(np.arctan2(joint.axis @ np.cross(start, end), start @ end))
    off = (turn - angle + np.pi / 4.0) % (np.pi / 2.0) - np.pi / 4.0
    return float(angle + off) if abs(off) <= SQUARE else None


def _across(frame: FloatArray, axis: FloatArray) -> FloatArray:
    """Return the axis of a frame that is most nearly across another, made so, shape [3]."""
    chosen = frame[int(np.abs(frame @ axis).argmin())]
    flat = chosen - axis * float(axis @ chosen)
    return np.asarray(flat / np.linalg.norm(flat))


def _near(body: Body, joint: Joint, value: float) -> float:
    """Return the share of a part's surface near what it hangs on, with its joint at a value."""
    if not len(body.held):
        return 0.0
    motion = joint.motion(value)
    points = body.own.points @ motion[:3, :3].T + motion[:3, 3]
    distance, _ = cKDTree(body.held.points).query(points)
    return float(np.mean(distance < NEAR_BY * body.partition.mesh.diagonal))
