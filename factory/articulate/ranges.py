"""Joint ranges made sound: limits finite and ordered, the input pose at zero, lower = closed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import tau

import numpy as np

from ..articulation import Joint, JointKind
from ..errors import InputRejected
from ..geometry.posing import moved
from ..mesh import BoolArray, FloatArray, Mesh
from .draft import Draft

#: Limits may not lie further from zero than this [rad]: engines stop a little beyond.
MOST_TURN = tau - 0.02
#: A range below this is no motion [rad] or [m].
NO_RANGE = 1e-6
#: Zero within this share of the range from an end counts as at that end.
AT_END = 0.02
#: Boxes whose volumes differ by less than this share say nothing about which pose is closed.
CLEAR_DIFFERENCE = 0.01
#: An input at its upper limit whose box shrinks by this share towards the lower one was modelled
#: open.
OPEN_DIFFERENCE = 0.2


def sound_limits(
    name: str, kind: str, lower: float | None, upper: float | None
) -> tuple[JointKind, float, float, list[str]]:
    """Return an annotated joint's kind and limits [rad] or [m], finite and ordered; and notes.

    The limits may still leave out 0, and may be equal.

    Raises:
        InputRejected: ``no_limits``: a slide must end somewhere; ``unsupported_joint``.
    """
    if kind not in set(JointKind):
        raise InputRejected(
            "unsupported_joint",
            f"joint {name!r}: is of kind {kind!r}; want fixed, revolute, continuous or prismatic",
        )
    known = JointKind(kind)
    if known is JointKind.FIXED:
        return known, 0.0, 0.0, []
    if known is JointKind.CONTINUOUS:
        return known, -np.pi, np.pi, []
    if lower is None or upper is None or not (np.isfinite(lower) and np.isfinite(upper)):
        if known is JointKind.PRISMATIC:
            raise InputRejected(
                "no_limits",
                f"joint {name!r}: slides between {lower} and {upper}; want finite limits",
            )
        note = f"joint {name!r} has no limits: taken as continuous"
        return JointKind.CONTINUOUS, -np.pi, np.pi, [note]
    notes = []
    if lower > upper:
        lower, upper = upper, lower
        notes.append(
            f"joint {name!r}: lower limit above the upper one; "
            f"swapped to [{lower:.6g}, {upper:.6g}]"
        )
    if known is JointKind.REVOLUTE and max(-lower, upper) > tau * (1.0 + 1e-6):
        notes.append(
            f"joint {name!r}: turns to [{lower:.6g}, {upper:.6g}] rad, over a full turn: "
            "taken as continuous"
        )
        return JointKind.CONTINUOUS, -np.pi, np.pi, notes
    if known is JointKind.REVOLUTE and upper - lower > tau * (1.0 + 1e-6):
        notes.append(f"joint {name!r}: turns by {upper - lower:.4g} rad in all, over a full turn")
    if known is JointKind.REVOLUTE and max(-lower, upper) > MOST_TURN:
        lower = max(lower, -MOST_TURN)
        upper = min(upper, MOST_TURN)
        notes.append(
            f"joint {name!r}: ends at [{lower:.6g}, {upper:.6g}] rad: PhysX counts a full turn on "
            "from the other side, and whoever pushes against a limit there passes it"
        )
    return known, float(lower), float(upper), notes


def with_zero_inside(draft: Draft, values: dict[str, float]) -> Draft:
    """Pose the object so that no joint's limits leave out its pose, which is the new zero.

    The mesh, and axes and origins of joints further out, move along. Needs ordered joints.

    Args:
        draft: anything.
        values: of the joints that are elsewhere than at 0 then, within their limits.
    """
    if not values:
        return draft
    poses = draft.poses(values)
    joints = []
    notes = []
    for joint in draft.joints:
        pose = poses[joint.parent]
        value = values.get(joint.name, 0.0)
        shift = 0.0 if joint.kind is JointKind.CONTINUOUS else value
        if value:
            unit = joint.unit
            why = (
                f"it follows {joint.mimic.leader!r}"
                if joint.mimic is not None and joint.lower <= 0.0 <= joint.upper
                else f"0 is outside [{joint.lower:.6g}, {joint.upper:.6g}] {unit}"
            )
            notes.append(
                f"joint {joint.name!r}: {why}; posed at {value:.6g} {unit}, which is the new zero"
            )
        joints.append(
            replace(
                joint,
                axis=pose[:3, :3] @ joint.axis,
                origin=pose[:3, :3] @ joint.origin + pose[:3, 3],
                lower=joint.lower - shift,
                upper=joint.upper - shift,
            )
        )
    mesh = moved(draft.mesh, draft.face_part, poses)
    return replace(draft, mesh=mesh, joints=tuple(joints)).noting(*notes)


def without_still_joints(draft: Draft) -> Draft:
    """Return the joints without a range become fixed."""
    still = {j.name: j for j in draft.joints if j.movable and j.range <= NO_RANGE}
    joints = tuple(
        replace(j, kind=JointKind.FIXED, lower=0.0, upper=0.0) if j.name in still else j
        for j in draft.joints
    )
    return replace(draft, joints=joints).noting(
        *(
            f"joint {name!r} has a range of {joint.range:.3g} {joint.unit}: taken as fixed"
            for name, joint in still.items()
        )
    )


def closed_at_lower(draft: Draft, posed: frozenset[str] = frozenset()) -> Draft:
    """Return every joint with its lower limit closed; needs ordered joints and 0 within the limits.

    The input pose is taken as closed when it is at one end of the range, unless that is the upper
    one and the object is far smaller at the other. When it is inside, the end at which the whole
    object fills the smaller axis-aligned box is closed; when neither does, nothing changes.

    Args:
        draft: anything.
        posed: joints not as drawn: the pose of a hinge then says nothing; a slide would sink in.
    """
    notes = []
    undecided = []
    turned = set()
    for joint in draft.joints:
        # A follower is closed where its leader is.
        if joint.kind not in (JointKind.REVOLUTE, JointKind.PRISMATIC) or joint.mimic is not None:
            continue
        drawn = joint.kind is JointKind.PRISMATIC or joint.name not in posed
        flip, note = _opens_downwards(draft, joint, drawn=drawn)
        notes += [note] if note else []
        if flip is None:
            undecided.append(joint.name)
        elif flip:
            turned.add(joint.name)
    joints = []
    for joint in draft.joints:
        mimic = joint.mimic
        if mimic is not None and mimic.leader in turned:
            back = replace(mimic, multiplier=-mimic.multiplier)
            joints.append(replace(joint, mimic=back))
        else:
            joints.append(turned_round(joint) if joint.name in turned else joint)
    if undecided:
        notes.append(
            "the input pose is inside the range and neither end is clearly closed, "
            "so the lower limit is taken as "
            f"closed, for {'joint' if len(undecided) == 1 else 'joints'} "
            f"{', '.join(map(repr, undecided))}"
        )
    return replace(draft, joints=tuple(joints)).noting(*notes)


def turned_round(joint: Joint) -> Joint:
    """Return the same joint, opening the other way: its axis and limits reversed."""
    return replace(joint, axis=-joint.axis, lower=-joint.upper, upper=-joint.lower)


def _opens_downwards(draft: Draft, joint: Joint, *, drawn: bool) -> tuple[bool | None, str]:
    """Return whether the upper limit is closed, ``None`` where nothing tells; and a note."""
    near = AT_END * joint.range
    if drawn and -joint.lower <= near:
        return False, ""
    inside = np.isin(draft.face_part, list(draft.subtree(joint.child)))
    low, high = box_volumes(draft.mesh, inside, joint, (joint.lower, joint.upper))
    if drawn and joint.upper <= near:
        if low <= (1.0 - OPEN_DIFFERENCE) * high:
            why = "is taken as open; the object is far smaller at the other end"
            return False, f"joint {joint.name!r}: the input pose {why}"
        return True, f"joint {joint.name!r}: opened towards its lower limit; its axis is reversed"
    if abs(low - high) <= CLEAR_DIFFERENCE * max(low, high):
        return None if drawn else joint.upper <= near, ""
    place = "inside" if drawn else "outside"
    where = (
        f"joint {joint.name!r}: the input pose is {place} its range "
        f"[{joint.lower:.4g}, {joint.upper:.4g}]"
    )
    why = "where the object is smallest, is taken as closed"
    if low < high:
        return False, f"{where}; its lower limit, {why}"
    return True, f"{where}; its upper limit, {why}, its axis reversed"


def box_volumes(
    mesh: Mesh, inside: BoolArray, joint: Joint, values: Sequence[float] | FloatArray
) -> FloatArray:
    """Return the volume [m3] of an object's box with one joint moved to each value; none is flat.

    Args:
        mesh: the object [m].
        inside: of each face whether the joint moves it, shape [face_count].
        joint: of the object.
        values: to which the joint is moved [rad] or [m], shape [n].
    """
    moving, rest = (mesh.vertices[np.unique(mesh.faces[some])] for some in (inside, ~inside))
    extents = []
    for value in values:
        motion = joint.motion(float(value))
        moved = moving @ motion[:3, :3].T + motion[:3, 3]
        extents.append(np.ptp(np.concatenate([rest, moved]), axis=0))
    thick = np.array(extents) + 0.01 * np.linalg.norm(extents, axis=1, keepdims=True)
    return np.asarray(thick.prod(axis=1))
