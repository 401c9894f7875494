"""Joints that follow others in an annotation: what can be kept of it, and made alike."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from asset_factory.sim_checks.description import Mimic
from asset_factory.sim_checks.geometry.coupling import Limits, leaders, whole_chain

from ..articulation import Joint
from ..geometry.coupling import common_limits, limits_of, sound_mimics, with_common_ranges
from .draft import Draft
from .ranges import AT_END, MOST_TURN, NO_RANGE, turned_round


def with_sound_mimics(draft: Draft) -> Draft:
    """Return the draft without what no joint can follow: nothing, itself, or at no rate at all."""
    mimics = {n: m for n, m in sound_mimics(draft.joints).items() if abs(m.multiplier) > NO_RANGE}
    return _following(draft, mimics, "follows no joint that moves")


def resting_values(draft: Draft) -> tuple[Draft, dict[str, float]]:
    """Return where joints are in the pose that becomes zero: within limits, followers following.

    A follower that its leader takes clearly out of its limits follows no more.

    Returns:
        The draft, its mimics about that pose; the value of each joint that is not at 0 there.
    """
    mimics = sound_mimics(draft.joints)
    known = {j.name: j for j in draft.joints if j.movable}
    values: dict[str, float] = {}
    kept: dict[str, Mimic] = {}
    for joint in sorted(known.values(), key=lambda each: len(leaders(each.name, mimics))):
        lower, upper = limits_of(joint)
        mimic = mimics.get(joint.name)
        at = 0.0 if mimic is None else mimic.multiplier * values[mimic.leader] + mimic.offset
        within = float(np.clip(at, lower, upper))
        if mimic is not None and abs(at - within) <= AT_END * (upper - lower):
            kept[joint.name] = replace(mimic, offset=0.0)
        elif mimic is not None:
            within = float(np.clip(0.0, lower, upper))
        values[joint.name] = within
    moved = {name: value for name, value in values.items() if value}
    return _following(draft, kept, "would leave its limits with its leader"), moved


def with_common_motion(draft: Draft) -> Draft:
    """Return the draft without followers that have no range in common with their leader."""
    mimics = sound_mimics(draft.joints)
    kept = {n: m for n, m in mimics.items() if _is_common(draft.joints, whole_chain(n, mimics))}
    return _following(draft, kept, "has no range in common with it")


def moving_together(draft: Draft) -> Draft:
    """Return the draft with followers opening as their leaders do, and all over one range."""
    joints = list(draft.joints)
    mimics = sound_mimics(joints)
    turned = {name for name in mimics if whole_chain(name, mimics).multiplier < 0.0}
    for index, joint in enumerate(joints):
        if joint.mimic is None:
            continue
        made = replace(joint, mimic=replace(joint.mimic, multiplier=abs(joint.mimic.multiplier)))
        joints[index] = turned_round(made) if joint.name in turned else made
    return replace(draft, joints=with_common_ranges(joints))


def _is_common(joints: Sequence[Joint], whole: Mimic) -> bool:
    limits: Limits | None = common_limits(joints).get(whole.leader)
    if limits is None or limits[1] - limits[0] <= NO_RANGE:
        return False
    leader = next(joint for joint in joints if joint.name == whole.leader)
    return (
        not leader.turns or max(-limits[0], limits[1]) <= MOST_TURN or bool(np.isinf(limits).all())
    )


def _following(draft: Draft, mimics: dict[str, Mimic], why: str) -> Draft:
    """Return the draft with these mimics alone, and a note of each that is lost."""
    lost = [j for j in draft.joints if j.mimic is not None and j.name not in mimics]
    joints = tuple(replace(j, mimic=mimics.get(j.name)) for j in draft.joints)
    return replace(draft, joints=joints).noting(
        *(
            f"joint {j.name!r} follows {j.mimic.leader!r} in the file, but {why}: it moves freely"
            for j in lost
            if j.mimic is not None
        )
    )
