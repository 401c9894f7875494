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
