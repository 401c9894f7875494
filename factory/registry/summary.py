"""``summary.json``: what a build did, one row per input."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import asdict
from typing import Any

from .result import Result


def summarize(results: Iterable[Result], state: str = "finished", left: int = 0) -> dict[str, Any]:
    """JSON data: ``inputs`` by status, how it ended, ``reasons``, and ``assets`` by input.

    Args:
        results: one per input, in any order.
        state: how the job ended: ``finished``, ``out_of_time``, ``limit_reached`` or
            ``interrupted``.
        left: inputs that were not begun, or not finished when it was interrupted.
    """
    ordered = sorted(results, key=lambda result: result.input)
    statuses = Counter(result.status for result in ordered)
    reasons = Counter(result.reason for result in ordered if result.reason)
    return {
        "inputs": len(ordered),
        "passed": statuses["passed"],
        "rejected": statuses["rejected"],
        "unjudged": statuses["unjudged"],
        "known": sum(result.known for result in ordered),
        "left": left,
        "state": state,
        "reasons": dict(sorted(reasons.items())),
        "assets": [_row(result) for result in ordered],
    }


def _row(result: Result) -> dict[str, Any]:
    row = asdict(result)
    row["seconds"] = round(result.seconds, 3)
    row["stages"] = {stage: round(seconds, 3) for stage, seconds in result.stages.items()}
    return row
