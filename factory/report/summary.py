"""``summary.json``: what a job did, one row per input."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

from asset_factory.sim_checks import Status

from ..registry.result import Result


class JobState(StrEnum):
    """How a job ended."""

    FINISHED = "finished"
    LIMIT_REACHED = "limit_reached"
    OUT_OF_TIME = "out_of_time"
    INTERRUPTED = "interrupted"


@dataclass(frozen=True)
class Summary:
    """What a job did.

    Attributes:
        results: one per input, in any order.
        state: how the job ended.
        left: inputs that were not begun, or not finished when it was interrupted.
    """

    results: tuple[Result, ...]
    state: JobState = JobState.FINISHED
    left: int = 0

    def count(self, status: Status) -> int:
        """Return how many inputs ended so."""
        return sum(result.entry.status is status for result in self.results)

    def to_dict(self) -> dict[str, Any]:
        """Return JSON data: inputs by status, how it ended, ``reasons``, ``assets`` by input."""
        ordered = sorted(self.results, key=lambda result: result.input)
        reasons = Counter(result.entry.reason for result in ordered if result.entry.reason)
        return {
            "inputs": len(ordered),
            **{str(status): self.count(status) for status in Status},
            "known": sum(result.known for result in ordered),
            "left": self.left,
            "state": self.state,
            "reasons": dict(sorted(reasons.items())),
            "assets": [result.to_dict() for result in ordered],
        }
