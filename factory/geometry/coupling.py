"""Joints that follow others, kept together: none without its leader, all with one common range."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from asset_factory.sim_checks.description import Mimic
from asset_factory.sim_checks.geometry.coupling import (
    Limits,
    common_ranges,
    sound_chains,
    whole_chain,
)

from ..articulation import Joint, JointKind


def with_leaders(joints: Sequence[Joint]) -> tuple[Joint, ...]:
    """Return the same joints; those whose leader is gone or fixed follow nothing any more."""
    mimics = sound_mimics(joints)
    return tuple(replace(joint, mimic=mimics.get(joint.name)) for joint in joints)


def sound_mimics(joints: Sequence[Joint]) -> dict[str, Mimic]:
    """Return how those joints follow that move and whose chain ends at one that moves freely."""
    return sound_chains({joint.name: joint.mimic for joint in joints if joint.movable})


def with_common_ranges(joints: Sequence[Joint]) -> tuple[Joint, ...]:
    """Return the joints with limits that all who move together reach together.

    Args:
        joints: followers at ratios above 0 of their leaders, all zero together.
    """
    joints = with_leaders(joints)
    mimics = sound_mimics(joints)
    ranges = common_limits(joints)
    return tuple(_within(joint, mimics, ranges) for joint in joints)


def common_limits(joints: Sequence[Joint]) -> dict[str, Limits]:
    """Return how far free joints go, their followers within their limits; none that go nowhere."""
    return common_ranges({joint.name: limits_of(joint) for joint in joints}, sound_mimics(joints))


def limits_of(joint: Joint) -> Limits:
    """Return a joint's limits [rad] or [m], infinite where it turns on and on."""
    endless = joint.kind is JointKind.CONTINUOUS
    return (-np.inf, np.inf) if endless else (joint.lower, joint.upper)


def _within(joint: Joint, mimics: Mapping[str, Mimic], ranges: Mapping[str, Limits]) -> Joint:
    whole = whole_chain(joint.name, mimics) if joint.name in mimics else Mimic(joint.name)
    limits = ranges.get(whole.leader)
    if limits is None or not np.isfinite(limits).all():
        return joint
    lower, upper = (whole.multiplier * end for end in limits)
    kind = JointKind.REVOLUTE if joint.turns else joint.kind
    return replace(joint, kind=kind, lower=lower, upper=upper)
