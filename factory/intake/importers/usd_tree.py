"""Bodies and joints as one tree: fixed joints weld, world or articulation root first."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

import numpy as np

from ...errors import InputRejected
from ..annotation import AnnotatedJoint, Annotation
from .imported import rigid_groups
from .usd_joints import UsdJoint
from .usd_stage import STATIC, UsdStage


@dataclass(frozen=True)
class _Link:
    """A moving joint between two groups of welded bodies, of its ``body0`` and ``body1``."""

    joint: UsdJoint
    first: int
    second: int


def annotation_of(stage: UsdStage, file: str) -> Annotation:
    """Parts and joints of a stage, in its frame and units; faces in the order of its pieces.

    Bodies that no joint holds stand still: they are fixed to the root.

    Args:
        stage: with at least one piece.
        file: name for messages.

    Raises:
        InputRejected: ``not_a_tree``: the joints close a loop.
    """
    bodies = list(
        dict.fromkeys(
            [*(body for body, _ in stage.pieces), *(b for j in stage.joints for b in j.bodies)]
        )
    )
    index = {body: number for number, body in enumerate(bodies)}
    ends = [(joint, index[joint.bodies[0]], index[joint.bodies[1]]) for joint in stage.joints]
    group = rigid_groups(len(bodies), [(a, b) for joint, a, b in ends if joint.kind == "fixed"])
    links = [_Link(joint, group[a], group[b]) for joint, a, b in ends if joint.kind != "fixed"]
    face_group = np.concatenate(
        [np.full(len(mesh.faces), group[index[body]]) for body, mesh in stage.pieces]
    )
    order = _by_rank(
        links,
        group,
        [index[body] for body in stage.roots if body in index],
        index.get(STATIC),
        face_group,
    )
    joints = _directed(links, order, file)
    number = {g: part for part, g in enumerate(order)}
    return Annotation(
        face_part=np.array([number[g] for g in face_group.tolist()]),
        part_names=tuple(_name(bodies[g]) for g in order),
        joints=tuple(
            _annotated(
                link,
                number[parent],
                number[child],
                reversed_=link is not None and link.second == parent,
            )
            for link, parent, child in joints
        ),
        source="usd",
    )


def _by_rank(
    links: list[_Link],
    group: list[int],
    roots: list[int],
    static: int | None,
    face_group: np.ndarray,
) -> list[int]:
    """The groups, best root first: the world's, articulation root, no ``body1``, then size."""
    faces = Counter(face_group.tolist())
    world = None if static is None else group[static]
    first = {group[body] for body in roots}
    moved = {link.second for link in links}

    def rank(g: int) -> tuple[bool, bool, bool, int, int]:
        return g != world, g not in first, g in moved, -faces[g], g

    return sorted(set(group), key=rank)


def _directed(
    links: list[_Link], order: list[int], file: str
) -> list[tuple[_Link | None, int, int]]:
    """Every joint with its parent's and child's group, away from the root; ``None``: fixed."""
    at: dict[int, list[int]] = {}
    for number, link in enumerate(links):
        for end in (link.first, link.second):
            at.setdefault(end, []).append(number)
    joints: list[tuple[_Link | None, int, int]] = []
    reached: set[int] = set()
    used: set[int] = set()
    for start in order:
        if start in reached:
            continue
        if reached:
            joints.append((None, order[0], start))
        waiting = [start]
        reached.add(start)
        for here in waiting:
            for number in at.get(here, []):
                if number in used:
                    continue
                link = links[number]
                there = link.second if link.first == here else link.first
                if there in reached:
                    message = (
                        f"{file}: joint {link.joint.name!r} closes a loop; "
                        "want one way to every body"
                    )
                    raise InputRejected("not_a_tree", message)
                used.add(number)
                reached.add(there)
                waiting.append(there)
                joints.append((link, here, there))
    return joints


def _annotated(link: _Link | None, parent: int, child: int, *, reversed_: bool) -> AnnotatedJoint:
    """Return the joint; seen from ``body1``, ``body0`` moves the other way round."""
    if link is None:
        up = np.array([0.0, 0.0, 1.0])
        return AnnotatedJoint(f"hold_{child}", "fixed", parent, child, up, np.zeros(3), None, None)
    joint = link.joint
    axis = -joint.axis if reversed_ else joint.axis
    return AnnotatedJoint(
        joint.name, joint.kind, parent, child, axis, joint.anchor, joint.lower, joint.upper
    )


def _name(body: str) -> str:
    return body.rsplit("/", 1)[-1] or "base"
