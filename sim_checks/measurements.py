"""What the penetration check measured, as a report holds it: written and read here."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import msgspec

#: Of a check's measurements in a report.
PENETRATION = "penetration"


@dataclass(frozen=True)
class MeasuredContact:
    """How two parts meet in one pose.

    Attributes:
        links, shapes: whose hulls are worst.
        depth_mm: of the hulls [mm]; negative is a gap.
        point_m: middle of the overlap in the root's frame [m]; ``None`` where they do not meet.
        kind: how an overlap of the pair counts: ``plain``, ``hinge`` or ``excluded``.
        visual_mm: of the visible surfaces [mm]: a positive gap, at most the clearance that is
            measured, or a negative depth; ``None`` where it was not measured.
        cause: why, where that can be told.
    """

    links: tuple[str, str]
    shapes: tuple[str, str]
    depth_mm: float
    point_m: tuple[float, ...] | None
    kind: str
    visual_mm: float | None
    cause: str | None


@dataclass(frozen=True)
class MeasuredPair(MeasuredContact):
    """The worst of one pair of parts along one joint.

    Attributes:
        excess_mm: depth beyond rest [mm]; negative is the smallest gap.
        bound_mm: nothing anywhere along the joint is worse than this [mm].
        at: joint value [rad] or [m].
    """

    excess_mm: float
    bound_mm: float
    at: float


@dataclass(frozen=True)
class MeasuredJoint:
    """One joint over its whole range.

    Attributes:
        joint: its name.
        lower, upper, unit: the range swept [rad] or [m].
        excess_mm: worst depth beyond rest of the pairs that count [mm].
        clearance_mm: smallest gap of the hulls [mm]; ``None`` if nothing comes near.
        visual_clearance_mm: gap of the visible surfaces, where the hulls come nearest [mm].
        clear_until: how far a joint that never opens goes from lower before it fails.
        looks: exact evaluations that it took to be certain.
        pairs: pairs of parts that come near each other.
        needs_open: joints that must be open before it, in the order in which they open.
        waits_for: joints that would have to be open and never are.
        with_those_open: the same joint with those that it needs open.
    """

    joint: str
    lower: float
    upper: float
    unit: str
    excess_mm: float
    clearance_mm: float | None
    visual_clearance_mm: float | None
    clear_until: float | None
    looks: int
    pairs: tuple[MeasuredPair, ...]
    needs_open: tuple[str, ...]
    waits_for: tuple[str, ...]
    with_those_open: MeasuredJoint | None


@dataclass(frozen=True)
class MeasuredNeighbour(MeasuredPair):
    """The worst of one pair while one joint makes its way and another stands open.

    Attributes:
        joint, unit: the one that moves, and the unit of its values.
        open, open_at: the one that stands open, and its value; ``None`` for upper.
        free_until: how far ``joint`` goes from lower there before it fails; ``None``: all the way.
    """

    joint: str
    open: str
    unit: str
    open_at: float | None = None
    free_until: float | None = None


@dataclass(frozen=True)
class MeasuredCombination(MeasuredContact):
    """One pair's worst over the joint combinations tried, with the joints' values there."""

    excess_mm: float
    values: Mapping[str, float]


@dataclass(frozen=True)
class MeasuredPenetration:
    """Everything that the check measured.

    Attributes:
        diagonal_m: of the object [m].
        hulls: how many.
        parts: links that move as one.
        rest, zero: contacts with every joint at lower, and with every joint at 0; ``None`` if that
            is the same pose.
        joints: each over its range.
        neighbours, combinations: what joints do while others are open.
    """

    diagonal_m: float
    hulls: int
    parts: tuple[tuple[str, ...], ...]
    rest: tuple[MeasuredContact, ...]
    zero: tuple[MeasuredContact, ...] | None
    joints: tuple[MeasuredJoint, ...]
    neighbours: tuple[MeasuredNeighbour, ...]
    combinations: tuple[MeasuredCombination, ...]

    @property
    def contacts(self) -> Iterator[MeasuredContact]:
        """Yield every two parts that come near, at rest and along the joints."""
        yield from self.rest
        yield from self.zero or ()
        for joint in self.joints:
            yield from joint.pairs

    def to_dict(self) -> dict[str, Any]:
        """Return JSON data."""
        return msgspec.json.decode(msgspec.json.encode(self), type=dict[str, Any])


def penetrations(measurements: Mapping[str, Any]) -> tuple[MeasuredPenetration, ...]:
    """Return the measurements of each file of an asset, from a report's by file and check.

    Those of another version are left out.
    """
    found = []
    for checks in measurements.values():
        data = checks.get(PENETRATION) if isinstance(checks, Mapping) else None
        if data:
            with suppress(msgspec.ValidationError):
                found.append(msgspec.convert(data, MeasuredPenetration))
    return tuple(found)
