"""Hulls that were joined to be fewer, and are in the way now, are left as they were decomposed."""

from __future__ import annotations

from dataclasses import replace

from ...manufacture.plan import Plan
from ...manufacture.repair import Repair, RepairKind
from .evidence import RepairEvidence


def fit_closely(evidence: RepairEvidence, plan: Plan) -> Plan | None:
    """Return all of an asset that is rejected for a part that was joined, once.

    Not where hulls were joined because the asset had too many.
    """
    if plan.closely or plan.fewer is not None:
        return None
    joined = {part for each in evidence.found("hulls_joined") for part in each.parts}
    if not any(joined.intersection(each.parts or joined) for each in evidence.hard):
        return None
    left = Repair(RepairKind.HULLS_NOT_JOINED, parts=tuple(sorted(joined)))
    return replace(plan, closely=True, repairs=(*plan.repairs, left))
