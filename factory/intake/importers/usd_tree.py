"""Bodies and joints as one tree: fixed joints weld, world or articulation root first."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from asset_factory.sim_checks.description import Mimic
from asset_factory.sim_checks.read.usd.bodies import WORLD
from asset_factory.sim_checks.read.usd.joints import PhysicsJoint
from asset_factory.sim_checks.read.usd.stage import PhysicsStage

from ...articulation import rotation_about
from ...errors import InputRejected
from ...mesh import FloatArray, Mesh
from ..annotation import AnnotatedJoint
from ..limits import unreadable
from .imported import Imported, fixed, rigid_groups

ALIGNED = np.radians(2.0)
"""Angle between two bodies' joint frames, about another axis than the joint's, to match [rad].

Beyond it nothing is known about the joint's value at the authored pose."""
CLOSE = 0.02
"""The same for their distance off the axis, as a share of that along it or of the joint's range."""


def hang_pieces(
    stage: PhysicsStage, pieces: Sequence[tuple[str, Mesh]], frame: FloatArray, file: str
) -> Imported:
    """Return a stage's surfaces by the parts that its joints make of its bodies.

    Bodies that no joint holds stand still: they are fixed to the root.

    Args:
        stage: as it was read.
        pieces: bodies and their meshes, at least one [m], z up.
        frame: from the file's own frame to that of the pieces, shape [4, 4].
        file: name for messages.

    Raises:
        InputRejected: ``unsupported_joint``; ``not_a_tree``: the joints close a loop.
    """
    ends = [body for joint in stage.joints for body in joint.bodies]
    bodies = list(dict.fromkeys([*(body for body, _ in pieces), *ends]))
    index = {body: number for number, body in enumerate(bodies)}
    joints = [_joint_at_pose(joint, stage, index, frame) for joint in stage.joints]
    group = rigid_groups(len(bodies), [(j.parent, j.child) for j in joints if j.kind == "fixed"])
    # Moving joints between groups of welded bodies, those of their ``body0`` and ``body1``.
    moving = (joint for joint in joints if joint.kind != "fixed")
    links = [replace(j, parent=group[j.parent], child=group[j.child]) for j in moving]
    roots = {group[index[body]] for body in stage.roots if body in index}
    world = group[index[WORLD]] if WORLD in index else None
    moved = {link.child for link in links}
    count = Counter[int]()
    for body, mesh in pieces:
        count[group[index[body]]] += len(mesh.faces)

    def rank(g: int) -> tuple[bool, bool, bool, int, int]:
        """Rank groups, the best root first: world, articulation root, no ``body1``, then size."""
        return g != world, g not in roots, g in moved, -count[g], g

    order = sorted(set(group), key=rank)
    number = {g: part for part, g in enumerate(order)}
    return Imported(
        pieces=tuple((number[group[index[body]]], mesh) for body, mesh in pieces),
        part_names=tuple(bodies[g].rsplit("/", 1)[-1] or "base" for g in order),
        joints=tuple(_hung(links, number, file)),
        digests=(),
        notes=(),
        source="usd",
        frame=frame,
    )


def _joint_at_pose(
    joint: PhysicsJoint, stage: PhysicsStage, index: dict[str, int], transform: FloatArray
) -> AnnotatedJoint:
    """Return a joint between bodies, which are numbered by ``index``; limits from the pose."""
    if joint.kind not in ("revolute", "prismatic", "fixed"):
        why = f"is a {joint.kind}; want a revolute, prismatic or fixed joint"
        raise InputRejected("unsupported_joint", f"joint {joint.name!r}: {why}")
    first = stage.bodies[joint.bodies[0]].pose @ joint.frames[0]
    at = _authored_value(joint, stage)
    # A slide's limits are in the file's units, whatever the scale of its body.
    unit = float(np.cbrt(np.prod(stage.bodies[joint.bodies[0]].scale)))
    length = unit if joint.kind == "prismatic" else 1.0
    travelled = at / stage.metres if joint.kind == "prismatic" else at
    limits = (joint.lower, joint.upper)
    lower, upper = (None if each is None else each / length - travelled for each in limits)
    back = np.linalg.inv(transform)
    axis = transform[:3, :3].T @ first[:3, :3] @ joint.axis / stage.metres
    anchor = back[:3, :3] @ first[:3, 3]
    if not (np.isfinite(axis).all() and np.isfinite(anchor).all()):
        raise unreadable(f"joint {joint.name!r}", "its frame is not finite")
    parent, child = (index[body] for body in joint.bodies)
    made = AnnotatedJoint(joint.name, joint.kind, parent, child, axis, anchor, lower, upper)
    return replace(made, mimic=_mimic_at_pose(joint, stage))


def _mimic_at_pose(joint: PhysicsJoint, stage: PhysicsStage) -> Mimic | None:
    """Return what a joint follows, values from the pose and in the file's units."""
    mimic = joint.mimic
    leader = next((j for j in stage.joints if mimic is not None and j.name == mimic.leader), None)
    if mimic is None or leader is None:
        return None
    own, led = (_authored_value(each, stage) for each in (joint, leader))
    unit, led_unit = (stage.metres if each.kind == "prismatic" else 1.0 for each in (joint, leader))
    offset = (mimic.multiplier * led + mimic.offset - own) / unit
    return Mimic(leader.name, mimic.multiplier * led_unit / unit, offset)


def _authored_value(joint: PhysicsJoint, stage: PhysicsStage) -> float:
    """Return the joint's value at the authored pose [rad] or [m], as far as the file tells."""
    poses = [stage.bodies[body].pose for body in joint.bodies]
    first, second = (pose @ frame for pose, frame in zip(poses, joint.frames, strict=True))
    return _value_at_pose(joint, first, second) if joint.placed else 0.0


def _value_at_pose(joint: PhysicsJoint, first: FloatArray, second: FloatArray) -> float:
    """Return the joint's value at the authored pose [rad] or [m]; 0 where frames do not match.

    Args:
        joint: of which the file states both frames.
        first: the frame on ``body0``, in the stage's, shape [4, 4].
        second: the frame on ``body1``.
    """
    relative = first[:3, :3].T @ second[:3, :3]
    skew = relative - relative.T
    cross = np.array([skew[2, 1], skew[0, 2], skew[1, 0]])
    # Twice the sine and twice the cosine of a rotation about the axis; of another one the rest
    # below is not small.
    angle = float(np.arctan2(joint.axis @ cross, np.trace(relative) - 1.0))
    turned = angle if joint.kind == "revolute" else 0.0
    rest = rotation_about(joint.axis, -turned) @ relative
    off_angle = float(np.arccos(np.clip((np.trace(rest) - 1.0) / 2.0, -1.0, 1.0)))
    between = first[:3, :3].T @ (second[:3, 3] - first[:3, 3])
    along = float(between @ joint.axis)
    off_axis = float(np.linalg.norm(between - along * joint.axis))
    if joint.kind == "revolute":
        return turned if off_angle <= ALIGNED else 0.0
    reach = max(abs(along), abs(joint.upper or 0.0))
    return along if off_angle <= ALIGNED and off_axis <= CLOSE * reach else 0.0


def _hung(links: list[AnnotatedJoint], parts: dict[int, int], file: str) -> list[AnnotatedJoint]:
    """Return the joints between parts, from the root on; what none holds is fixed to the root.

    The parts' numbers are given by group, the root's first. Seen from ``body1``, ``body0`` moves
    the other way round.
    """
    at: dict[int, list[int]] = {}
    for number, link in enumerate(links):
        for end in (link.parent, link.child):
            at.setdefault(end, []).append(number)
    joints: list[AnnotatedJoint] = []
    reached: set[int] = set()
    used: set[int] = set()
    for start, part in parts.items():
        if start in reached:
            continue
        if reached:
            joints.append(fixed(f"hold_{part}", 0, part))
        waiting = [start]
        reached.add(start)
        for here in waiting:
            for number in at.get(here, []):
                if number in used:
                    continue
                link = links[number]
                there = link.child if link.parent == here else link.parent
                if there in reached:
                    why = f"joint {link.name!r} closes a loop; want one way to every body"
                    raise InputRejected("not_a_tree", f"{file}: {why}")
                used.add(number)
                reached.add(there)
                waiting.append(there)
                axis = -link.axis if link.child == here else link.axis
                hung = replace(link, parent=parts[here], child=parts[there], axis=axis)
                joints.append(hung)
    return joints
