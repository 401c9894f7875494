"""An articulation in the making: what normalisation passes from step to step."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..articulation import Joint, JointKind
from ..errors import InputRejected
from ..mesh import FloatArray, IntArray, Mesh, freeze


@dataclass(frozen=True)
class Draft:
    """Parts and joints in the object frame that need not be a valid tree yet.

    Attributes:
        mesh: object frame [m].
        face_part: part id per face, shape [face_count]; -1 where nobody said.
        names: by part id, as annotated.
        joints: their ``parent`` and ``child`` are part ids; in any order until :func:`ordered`.
        notes: departures so far, one sentence each.
    """

    mesh: Mesh
    face_part: IntArray
    names: tuple[str, ...]
    joints: tuple[Joint, ...]
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        freeze(self, "face_part", dtype=np.int64)

    def noting(self, *notes: str) -> Draft:
        """Return the same draft with more notes."""
        return replace(self, notes=(*self.notes, *notes))

    @property
    def root(self) -> int:
        """Return the part that no joint holds; only for one tree."""
        held = {joint.child for joint in self.joints}
        return next(part for part in range(len(self.names)) if part not in held)

    def poses(self, values: dict[str, float]) -> FloatArray:
        """Return motions of all parts relative to rest, by part id, [part_count, 4, 4].

        Args:
            values: joint values [rad] or [m] by joint name; a joint not named is at 0.
        """
        poses = np.tile(np.eye(4), (len(self.names), 1, 1))
        for joint in self.joints:
            poses[joint.child] = poses[joint.parent] @ joint.motion(values.get(joint.name, 0.0))
        return poses

    def subtree(self, part: int) -> set[int]:
        """Return the part and everything it carries; needs ordered joints."""
        carried = {part}
        for joint in self.joints:
            if joint.parent in carried:
                carried.add(joint.child)
        return carried


def ordered(draft: Draft, forest: bool) -> Draft:
    """Return the draft with its joints in tree order, parents first.

    Args:
        draft: any joints.
        forest: attach further trees to the largest one by fixed joints, instead of rejecting them.

    Raises:
        InputRejected: ``not_a_tree``, naming the parts.
    """
    holder: dict[int, Joint] = {}
    for joint in draft.joints:
        if joint.child in holder:
            raise InputRejected(
                "not_a_tree",
                f"part {draft.names[joint.child]!r} is the child of joints "
                f"{holder[joint.child].name!r} and {joint.name!r}; want one",
            )
        holder[joint.child] = joint
    roots = [part for part in range(len(draft.names)) if part not in holder]
    joints = _parents_first(draft.joints, roots)
    stuck = holder.keys() - {joint.child for joint in joints}
    if stuck:
        listed = ", ".join(repr(draft.names[part]) for part in sorted(stuck))
        raise InputRejected(
            "not_a_tree", f"parts {listed} form a cycle; want one tree from one root"
        )
    if len(roots) <= 1:
        return replace(draft, joints=joints)
    if not forest:
        listed = ", ".join(repr(draft.names[part]) for part in roots[:5])
        raise InputRejected(
            "not_a_tree", f"{len(roots)} parts have no parent ({listed}); want one root"
        )
    return _attached(replace(draft, joints=joints), roots)


def _parents_first(joints: tuple[Joint, ...], roots: list[int]) -> tuple[Joint, ...]:
    """Return the depth first, siblings in the order given."""
    children: dict[int, list[Joint]] = {}
    for joint in joints:
        children.setdefault(joint.parent, []).append(joint)
    result: list[Joint] = []
    stack = [joint for root in reversed(roots) for joint in reversed(children.get(root, []))]
    while stack:
        joint = stack.pop()
        result.append(joint)
        stack += reversed(children.get(joint.child, []))
    return tuple(result)


def _attached(draft: Draft, roots: list[int]) -> Draft:
    """Return ordered trees as one: the largest, to which the roots of the others are fixed."""

    def size(root: int) -> tuple[int, int, int]:
        tree = draft.subtree(root)
        return len(tree), int(np.isin(draft.face_part, list(tree)).sum()), -root

    main = max(roots, key=size)
    others = [root for root in roots if root != main]
    fixed = tuple(
        Joint(
            name=f"fix_{draft.names[root]}",
            kind=JointKind.FIXED,
            parent=main,
            child=root,
            axis=np.array([0.0, 0.0, 1.0]),
            origin=np.zeros(3),
        )
        for root in others
    )
    listed = ", ".join(repr(draft.names[root]) for root in others)
    joined = replace(draft, joints=_parents_first((*draft.joints, *fixed), [main]))
    return joined.noting(f"no joint holds {listed}: attached to {draft.names[main]!r}")
