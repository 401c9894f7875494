"""Joints that follow others: the leader of a chain, its map to them, and how far all can go."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

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


def led_by(sound: Mapping[str, Mimic]) -> dict[str, dict[str, Mimic]]:
    """Return leader -> follower -> their whole chain as one; leaders are free joints."""
    led: dict[str, dict[str, Mimic]] = {}
    for name in sound:
        whole = whole_chain(name, sound)
        led.setdefault(whole.leader, {})[name] = whole
    return led


def common_range(limits: Limits, followers: Iterable[tuple[Mimic, Limits | None]]) -> Limits | None:
    """Return a leader's limits, cut so that all followers keep theirs; ``None`` if nothing is left.

    Followers are given by how they follow the leader, with their own limits, if they have any.
    """
    for mimic, own in followers:
        if own is not None and mimic.multiplier != 0.0:
            ends = sorted((end - mimic.offset) / mimic.multiplier for end in own)
            limits = max(limits[0], ends[0]), min(limits[1], ends[1])
    return limits if limits[0] < limits[1] else None
