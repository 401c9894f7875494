"""What came of cutting the hulls of parts apart."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from ..decompose.decompose import PartHulls

Pair = tuple[str, str]


@dataclass(frozen=True)
class SeparationRefusal:
    """Why the hulls of two parts were not cut apart on all of their way.

    Attributes:
        reason: a sentence with the number in it.
        meshes: True where the parts' own solids are at fault; False where it may be their hulls
            only.
        at_rest: they were cut apart where they are at rest, only not along the way.
    """

    reason: str
    meshes: bool
    at_rest: bool = False


@dataclass(frozen=True)
class CutBack:
    """A visible cut.

    Attributes:
        part: its name.
        depth_m: deepest [m].
        share: of its collision volume.
        area: of its visible surface.
    """

    part: str
    depth_m: float
    share: float
    area: float


@dataclass(frozen=True)
class Separation:
    """What came of cutting.

    Attributes:
        pieces: one per part, in their order.
        refused: pair of part names -> why its hulls were not cut apart on all of their way.
        hidden: pair of part names -> how deep the parts themselves overlap at rest [m],
            where that is more than decomposition explains and the hidden share was cut out of the
            collision geometry.
        trimmed: pair of part names -> the visible cut.
    """

    pieces: tuple[PartHulls, ...]
    refused: Mapping[Pair, SeparationRefusal] = field(default_factory=dict)
    hidden: Mapping[Pair, float] = field(default_factory=dict)
    trimmed: Mapping[Pair, tuple[CutBack, ...]] = field(default_factory=dict)
