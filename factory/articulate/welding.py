"""Fewer parts: what does not move is one part, and what carries nothing is none."""

from dataclasses import replace

import numpy as np

from ..articulation import Joint
from .draft import Draft


def unlabelled_to_root(draft: Draft) -> Draft:
    """Return the faces that belong to no part go to the root."""
    loose = draft.face_part < 0
    if not loose.any():
        return draft
    root = draft.root
    return replace(draft, face_part=np.where(loose, root, draft.face_part)).noting(
        f"{int(loose.sum())} faces belong to no part: given to the root {draft.names[root]!r}"
    )


def welded(draft: Draft) -> Draft:
    """Return the parts held by fixed joints become one with their parents; needs ordered joints.

    The whole is called after its topmost member that has faces.
    """
    group = list(range(len(draft.names)))
    for joint in draft.joints:
        if not joint.movable:
            group[joint.child] = group[joint.parent]
    joints = tuple(replace(j, parent=group[j.parent]) for j in draft.joints if j.movable)
    if len(joints) == len(draft.joints):
        return draft
    owners = set(np.unique(draft.face_part).tolist())
    names = list(draft.names)
    notes = []
    order = [draft.root, *(joint.child for joint in draft.joints)]
    for top in dict.fromkeys(group):
        members = [part for part in order if group[part] == top]
        seen = [part for part in members if part in owners]
        names[top] = draft.names[seen[0]] if seen else draft.names[top]
        merged = [repr(draft.names[part]) for part in seen[1:]]
        if merged:
            notes.append(f"fixed to {names[top]!r} and made one part with it: {', '.join(merged)}")
    gone = [part for part in range(len(group)) if group[part] != part]
    return _without(
        replace(
            draft, face_part=np.asarray(group)[draft.face_part], names=tuple(names), joints=joints
        ),
        set(gone),
    ).noting(*notes)


def without_empty_leaves(draft: Draft) -> Draft:
    """Drop parts without faces that carry nothing, with their joints; needs ordered joints."""
    owners = set(np.unique(draft.face_part).tolist())
    kept: list[Joint] = []
    notes = []
    carrying: set[int] = set(owners)
    for joint in reversed(draft.joints):
        if joint.child in carrying:
            carrying.add(joint.parent)
            kept.append(joint)
        else:
            notes.append(
                f"part {draft.names[joint.child]!r} has no geometry and carries none: "
                "dropped with its joint"
            )
    if not notes:
        return draft
    gone = {joint.child for joint in draft.joints} - {joint.child for joint in kept}
    return _without(replace(draft, joints=tuple(reversed(kept))), gone).noting(*reversed(notes))


def _without(draft: Draft, gone: set[int]) -> Draft:
    """Return the draft renumbered without parts that own no face and hang on no joint."""
    kept = [part for part in range(len(draft.names)) if part not in gone]
    new = np.full(len(draft.names), -1)
    new[kept] = np.arange(len(kept))
    return replace(
        draft,
        face_part=new[draft.face_part],
        names=tuple(draft.names[part] for part in kept),
        joints=tuple(
            replace(j, parent=int(new[j.parent]), child=int(new[j.child])) for j in draft.joints
        ),
    )
