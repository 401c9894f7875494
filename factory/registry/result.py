"""What became of one input, as the summary lists it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Result:
    """One input's outcome.

    Attributes:
        id: of the registry entry.
        input: the path as it was given.
        status: ``passed``, ``rejected`` or ``unjudged``.
        reason: code of the first hard finding; empty if it passed.
        message: that finding's sentence; empty if it passed.
        parts, joints, hulls: how many parts, movable joints and convex pieces.
        seconds: wall-clock time [s].
        stages: wall-clock time by stage [s].
        key: what it was made from, as the registry keys it; empty if unknown.
        licence: of the input; empty if unknown.
        attempts: how often it was begun; 0 if it was known from before, more than 1 after a crash.
        reused: stages that were answered from the cache; ``build`` alone if it was known from
            before.
    """

    id: str
    input: str
    status: str
    reason: str = ""
    message: str = ""
    parts: int = 0
    joints: int = 0
    hulls: int = 0
    seconds: float = 0.0
    stages: Mapping[str, float] = field(default_factory=dict)
    key: str = ""
    licence: str = ""
    attempts: int = 1
    reused: tuple[str, ...] = ()

    @property
    def known(self) -> bool:
        """Whether the registry knew it already: same input, settings, stages and libraries."""
        return self.attempts == 0
