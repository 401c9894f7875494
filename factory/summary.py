"""``summary.json``: what a build did, one row per input."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import asdict
from typing import Any

from .result import Result


def summarize(results: Iterable[Result]) -> dict[str, Any]:
    """JSON data: ``inputs``, ``passed``, ``rejected``, ``unjudged``, ``reasons`` and ``assets``, sorted by input.

    Args:
        results: one per input, in any order.
    """
    ordered = sorted(results, key=lambda result: result.input)
    statuses = Counter(result.status for result in ordered)
    reasons = Counter(result.reason for result in ordered if result.reason)
    return {
        "inputs": len(ordered),
        "passed": statuses["passed"],
        "rejected": statuses["rejected"],
        "unjudged": statuses["unjudged"],
        "reasons": dict(sorted(reasons.items())),
        "assets": [_row(result) for result in ordered],
    }


def _row(result: Result) -> dict[str, Any]:
    row = asdict(result)
    row["seconds"] = round(result.seconds, 3)
    row["stages"] = {stage: round(seconds, 3) for stage, seconds in result.stages.items()}
    return row
