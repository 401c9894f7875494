"""Objects without the parts that nothing is seen of."""

from __future__ import annotations

from dataclasses import replace

from ....articulation import Articulation


def without_parts(articulation: Articulation, gone: set[int]) -> Articulation:
    """The object without some parts and their joints.

    Args:
        articulation: in which those parts have no faces.
        gone: parts, and with them every carrier that is left without anything to carry.

    Raises:
        ValueError: a part that stays hangs on one that should go, or nothing would be left to move.
    """
    leaving = set(gone)
    for joint in reversed(articulation.joints):
        children = {other.child for other in articulation.joints if other.parent == joint.child}
        if children and children <= leaving and not len(articulation.parts[joint.child].faces):
            leaving.add(joint.child)
    kept = [index for index in range(len(articulation.parts)) if index not in leaving]
    number = {old: new for new, old in enumerate(kept)}
    joints = [joint for joint in articulation.joints if joint.child in number]
    lost = [articulation.parts[joint.parent].name for joint in joints if joint.parent not in number]
    if lost or 0 in leaving or not any(joint.movable for joint in joints):
        raise ValueError(
            f"want to drop {[articulation.parts[i].name for i in sorted(gone)]}, but the rest needs them"
        )
    return replace(
        articulation,
        parts=tuple(articulation.parts[index] for index in kept),
        joints=tuple(replace(j, parent=number[j.parent], child=number[j.child]) for j in joints),
    )
