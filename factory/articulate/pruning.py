"""An articulation some of whose parts stay where they are."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from types import MappingProxyType

import numpy as np

from ..articulation import Articulation

_NO_CHANCES: Mapping[int, float] = MappingProxyType({})
_NOWHERE: Mapping[int, int] = MappingProxyType({})


def keep_parts(
    articulation: Articulation,
    kept: Collection[int],
    chances: Mapping[int, float] = _NO_CHANCES,
    into: Mapping[int, int] = _NOWHERE,
) -> Articulation:
    """Return an articulation in which only some parts move; the others are one with their parents.

    Args:
        articulation: any.
        kept: numbers of the parts that go on moving.
        chances: probabilities of parts, by number, in place of their confidence.
        into: kept parts that take others, which carry none, in place of their parents.
    """
    place = {0: 0}
    order = [0]
    faces = {0: [articulation.parts[0].faces]}
    joints = []
    for joint in articulation.joints:
        holder = place[joint.parent]
        if joint.child in into:
            continue
        if joint.child not in kept:
            place[joint.child] = holder
            faces[holder].append(articulation.parts[joint.child].faces)
            continue
        number = len(order)
        place[joint.child] = number
        order.append(joint.child)
        faces[number] = [articulation.parts[joint.child].faces]
        chance = chances.get(joint.child, joint.confidence)
        joints.append(replace(joint, parent=holder, child=number, confidence=chance))
    for taken, taker in into.items():
        faces[place[taker]].append(articulation.parts[taken].faces)
    parts = []
    for number, old in enumerate(order):
        part = articulation.parts[old]
        chance = chances.get(old, part.confidence)
        own = np.concatenate(faces[number])
        parts.append(replace(part, faces=own, confidence=chance))
    return replace(articulation, parts=tuple(parts), joints=tuple(joints))
