"""Parts made one with what they hang on."""

from collections.abc import Collection, Mapping
from dataclasses import replace

import numpy as np

from ..articulation import Articulation


def welded(
    articulation: Articulation, joints: Collection[str], onto: Mapping[str, int] | None = None
) -> Articulation:
    """Return the object without some joints: what they moved joins what they hung on.

    Args:
        articulation: any.
        joints: names; those that are not there change nothing. A part on a carrier that loses one
            of its two joints becomes the carrier.
        onto: joint -> the part that its own becomes one with instead, which keeps its joint; only
            of parts that carry none.
    """
    group = list(range(len(articulation.parts)))
    for joint in articulation.joints:
        if joint.name in joints:
            group[joint.child] = group[joint.parent]
    for joint in articulation.joints:
        if onto and joint.name in onto:
            group[joint.child] = group[onto[joint.name]]
    kept = [index for index, top in enumerate(group) if top == index]
    new = {old: index for index, old in enumerate(kept)}
    parts = tuple(
        replace(
            articulation.parts[top],
            faces=np.concatenate(
                [
                    articulation.parts[index].faces
                    for index in range(len(group))
                    if group[index] == top
                ]
            ),
        )
        for top in kept
    )
    left = tuple(
        replace(joint, parent=new[group[joint.parent]], child=new[joint.child])
        for joint in articulation.joints
        if group[joint.child] == joint.child
    )
    return replace(articulation, parts=parts, joints=left)
