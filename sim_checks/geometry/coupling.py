"""Joints that follow others: the leader of a chain, its map to them, and how far all can go."""

from __future__ import annotations

from collections.abc import Mapping

from ..description import Mimic, sensible

Limits = tuple[float, float]
"""Lower and upper [rad] or [m]; infinite where there is none."""


def sound_chains(mimics: Mapping[str, Mimic | None]) -> dict[str, Mimic]:
    """Return follower -> mimic, where the chain of leaders ends at a joint that follows nothing.

    One by a number that is none, or absurdly large, leads nowhere. Asked are all joints that move;
    a free one has ``None``.
    """
    led: dict[str, list[str]] = {}
    for name, mimic in mimics.items():
        if mimic is not None and sensible((mimic.multiplier, mimic.offset)):
            led.setdefault(mimic.leader, []).append(name)
    held = [name for name, mimic in mimics.items() if mimic is None]
    for leader in held:
        held += led.pop(leader, [])
    sound = frozenset(held)
    return {n: mimic for n, mimic in mimics.items() if mimic is not None and n in sound}


def leaders(name: str, mimics: Mapping[str, Mimic]) -> tuple[str, ...]:
    """Return whom a joint follows, the nearest first; none for a free one."""
    found: list[str] = []
    while name in mimics:
        name = mimics[name].leader
        found.append(name)
    return tuple(found)


def whole_chain(name: str, sound: Mapping[str, Mimic], leader: str | None = None) -> Mimic:
    """Return a chain of followers as one: the joint at its head, with factor and offset.

    Args:
        name: of the last follower.
        sound: follower -> mimic, without circles.
        leader: where to stop; ``None`` for the free joint at the head.
    """
    whole = sound[name]
    while whole.leader in sound and whole.leader != leader:
        before = sound[whole.leader]
        offset = whole.multiplier * before.offset + whole.offset
        whole = Mimic(before.leader, whole.multiplier * before.multiplier, offset)
    return whole


def common_ranges(
    limits: Mapping[str, Limits | None], sound: Mapping[str, Mimic]
) -> dict[str, Limits]:
    """Return the limits of free joints, cut so that all who follow them keep theirs.

    A joint of which nothing is left is left out, as is a free one without limits.

    Args:
        limits: of each joint, if it has any.
        sound: follower -> mimic, without circles.
    """
    common = {name: own for name, own in limits.items() if own is not None and name not in sound}
    for name in sound:
        whole = whole_chain(name, sound)
        own = limits.get(name)
        if own is not None and whole.multiplier != 0.0 and whole.leader in common:
            ends = sorted((end - whole.offset) / whole.multiplier for end in own)
            lower, upper = common[whole.leader]
            common[whole.leader] = max(lower, ends[0]), min(upper, ends[1])
    return {name: (lower, upper) for name, (lower, upper) in common.items() if lower < upper}
