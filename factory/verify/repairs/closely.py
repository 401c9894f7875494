"""Hulls that were joined to be fewer, and are in the way now, are left as they were decomposed."""

from __future__ import annotations

from dataclasses import replace

from ...manufacture.plan import Plan
from .evidence import RepairEvidence


def fit_closely(evidence: RepairEvidence, plan: Plan) -> Plan | None:
    """All of an asset that is rejected, once; not where it was joined because it had too many."""
    joined = {part for each in evidence.found("hulls_joined") for part in each.parts}
    if plan.closely or plan.fewer is not None or not joined or not evidence.hard:
        return None
    step = f"left the hulls of {', '.join(sorted(joined))} as many as they were: joined ones failed"
    return replace(plan, closely=True, steps=(*plan.steps, step))
