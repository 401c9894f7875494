"""What became of one input: made by its worker, completed by the registry, listed in a summary."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from .entry import Entry

#: In ``Result.reused``, of an input that the registry knew already.
WHOLE_BUILD = "build"


@dataclass(frozen=True)
class Result:
    """One input's outcome.

    Attributes:
        input: the path as it was given.
        entry: its row in the registry.
        seconds: wall-clock time [s].
        stages: wall-clock time by stage [s].
        attempts: how often it was begun; 0 if it was known from before, more than 1 after a crash.
        reused: stages that were answered from the cache; ``build`` alone if it was known from
            before.
        replaced: assets that the same mesh was before, with other files beside it.
    """

    input: str
    entry: Entry
    seconds: float = 0.0
    stages: Mapping[str, float] = field(default_factory=dict)
    attempts: int = 1
    reused: tuple[str, ...] = ()
    replaced: tuple[str, ...] = ()

    @property
    def known(self) -> bool:
        """Tell whether the registry knew it: same input, settings, stages and libraries."""
        return self.attempts == 0

    def to_dict(self) -> dict[str, Any]:
        """Return JSON data: a row of ``summary.json``."""
        entry = self.entry
        return {
            "id": entry.id,
            "input": self.input,
            "status": entry.status,
            "reason": entry.reason,
            "message": entry.message,
            "parts": entry.parts,
            "joints": entry.joints,
            "hulls": entry.hulls,
            "seconds": round(self.seconds, 3),
            "stages": {stage: round(seconds, 3) for stage, seconds in self.stages.items()},
            "key": entry.key,
            "license": entry.license,
            "attempts": self.attempts,
            "reused": list(self.reused),
        }


def known_result(source: str, entry: Entry) -> Result:
    """Return the result of an input that the registry knew already: nothing was done."""
    return Result(source, entry, attempts=0, reused=(WHOLE_BUILD,))
