"""Cut apart hulls that nearly touch, even where the validator tolerates it; engines do not."""

from __future__ import annotations

from dataclasses import replace

from ...manufacture.plan import Plan
from ...manufacture.repair import Repair, RepairKind
from .evidence import RepairEvidence, ordered


def separate_hulls(evidence: RepairEvidence, plan: Plan) -> Plan | None:
    """Return every pair nearer than ``near_mm`` that is not cut apart already."""
    near = {
        ordered(*contact.links)
        for contact in evidence.contacts()
        if contact.depth_mm > -evidence.config.near_mm
    }
    new = frozenset(near) - plan.separate
    if not new:
        return None
    cut = Repair(RepairKind.HULLS_CUT_APART, pairs=tuple(sorted(new)))
    return replace(plan, separate=plan.separate | new, repairs=(*plan.repairs, cut))
