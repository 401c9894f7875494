"""What still overlaps at a hinge's knuckle is excluded from contact, as other engines do anyway."""

from __future__ import annotations

from dataclasses import replace

from ...manufacture.plan import Plan
from ...manufacture.repair import Repair, RepairKind
from .evidence import RepairEvidence, ordered


def exclude_knuckles(evidence: RepairEvidence, plan: Plan) -> Plan | None:
    """Return every pair of parts with a ``hinge_overlap`` that is not excluded already."""
    found = {ordered(*f.parts) for f in evidence.found("hinge_overlap") if len(f.parts) == 2}
    new = frozenset(found) - plan.exclude
    if not new:
        return None
    excluded = Repair(RepairKind.CONTACT_EXCLUDED, pairs=tuple(sorted(new)))
    return replace(plan, exclude=plan.exclude | new, repairs=(*plan.repairs, excluded))
