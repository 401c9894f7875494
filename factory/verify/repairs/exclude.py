"""What still overlaps at a hinge's knuckle is excluded from contact, as other engines do anyway."""

from __future__ import annotations

from dataclasses import replace

from ...manufacture.plan import Plan
from .evidence import RepairEvidence, listed, ordered


def exclude_knuckles(evidence: RepairEvidence, plan: Plan) -> Plan | None:
    """Return every pair of parts with a ``hinge_overlap`` that is not excluded already."""
    found = {ordered(*f.parts) for f in evidence.found("hinge_overlap") if len(f.parts) == 2}
    new = frozenset(found) - plan.exclude
    if not new:
        return None
    step = f"excluded from contact in MuJoCo, as other engines do: {listed(new)}"
    return replace(plan, exclude=plan.exclude | new, steps=(*plan.steps, step))
