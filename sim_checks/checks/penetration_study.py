"""What the penetration check measures: how parts meet, in poses and along joints."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

from ..description import JointLine
from .cause import Cause

PartPair = tuple[int, int]


class PairKind(StrEnum):
    """How an overlap of two hulls counts."""

    PLAIN = "plain"
    HINGE = "hinge"
    """The knuckle of the hinge between the two parts."""
    EXCLUDED = "excluded"
    """The file excludes the two links from contact."""


@dataclass(frozen=True)
class Contact:
    """How two parts meet in one pose.

    Attributes:
        parts: their indices, ascending.
        hulls: which two hulls, as indices into the description's solids.
        links, shapes: whose hulls are worst, in the order of the hulls.
        depth: [m]; negative is a gap.
        at_rest: depth of the two hulls with every joint at lower [m]; 0 where they do not meet.
        point: middle of the overlap in the root's frame [m]; ``None`` where the hulls do not meet.
        kind: how an overlap of the pair counts.
        pose: joint values [rad] or [m] in which they meet so.
        visual: how the visible surfaces of the two parts stand there [m]: a positive gap or a
            negative depth, see :mod:`..surfaces`; ``None`` where it was not measured or a part
            shows nothing.
        cause: the likely reason, where one can be told; see :mod:`.cause`.
    """

    parts: PartPair
    hulls: PartPair
    links: tuple[str, str]
    shapes: tuple[str, str]
    depth: float
    at_rest: float
    point: tuple[float, ...] | None
    kind: PairKind
    pose: Mapping[str, float]
    visual: float | None = None
    cause: Cause | None = None

    @property
    def excess(self) -> float:
        """Return the depth beyond rest [m]; negative is a gap."""
        return self.depth - self.at_rest


@dataclass(frozen=True, kw_only=True)
class PairSweep(Contact):
    """The worst of one pair of parts along one joint.

    Attributes:
        bound: nothing anywhere along the joint is worse beyond rest than this [m].
        at: joint value [rad] or [m].
    """

    bound: float
    at: float


@dataclass(frozen=True)
class JointSweep:
    """One joint over its whole range.

    Attributes:
        joint: which moves.
        lower, upper: the range swept [rad] or [m].
        pairs: pairs of parts that come near each other.
        looks: exact evaluations that it took to be certain.
        needs_open: the other joints that must be open before this one opens, in the order in which
            they do.
        alternative: the same joint with those at upper; ``None`` if it needs none, or if it never
            opens.
        waits_for: of a joint that never opens, the others that would have to make way, but do not
            open themselves.
        clear_until: how far a joint that never opens goes from lower before it fails [rad] or [m].
    """

    joint: JointLine
    lower: float
    upper: float
    pairs: tuple[PairSweep, ...]
    looks: int
    needs_open: tuple[str, ...] = ()
    alternative: JointSweep | None = None
    waits_for: tuple[str, ...] = ()
    clear_until: float | None = None

    @property
    def excess(self) -> float:
        """Return the worst excess over rest [m] that counts; negative is a gap."""
        plain = (pair.excess for pair in self.pairs if pair.kind is PairKind.PLAIN)
        return max(plain, default=float("-inf"))


@dataclass(frozen=True)
class BothOpen:
    """The worst of one pair of parts while one joint makes its whole way and another stands open.

    Attributes:
        joint: the one that moves.
        other: the one that stands open.
        pair: where and how deep.
        obstructed: ``joint`` cannot reach its range once ``other`` is a little open: they meet
            where it is just that, and wherever further open it was tried.
        free_until: how far ``joint`` goes from lower before they meet [rad] or [m]; ``None`` where
            they do not meet too deeply.
    """

    joint: JointLine
    other: JointLine
    pair: PairSweep
    obstructed: bool
    free_until: float | None = None

    @property
    def other_at(self) -> float:
        """Return where the other stands [rad] or [m]."""
        return self.pair.pose[self.other.name]


@dataclass(frozen=True)
class Neighbours:
    """What joints do to one another when two of them are open.

    Attributes:
        met: the worst of every pair of joints and parts that meet.
        asked: how many pairs of joints have ways that come near each other.
        unswept: those of them that were left out, for the work that they take.
    """

    met: tuple[BothOpen, ...]
    asked: int
    unswept: tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class PenetrationStudy:
    """Everything measured.

    Attributes:
        rest, zero: contacts with every joint at lower, and with every joint at 0; ``None`` if that
            is the same pose, or one that joints do not reach.
        sweeps: each joint over its range.
        neighbours: what joints do while another is open.
        combinations: each pair's worst over the joint combinations tried.
    """

    rest: tuple[Contact, ...]
    zero: tuple[Contact, ...] | None
    sweeps: tuple[JointSweep, ...]
    neighbours: Neighbours
    combinations: tuple[Contact, ...]
