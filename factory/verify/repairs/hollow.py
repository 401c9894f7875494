"""A part whose inside its own hulls fill is made again as what it shows: walls around nothing."""

from __future__ import annotations

from dataclasses import replace

from ...manufacture.plan import Plan
from ...manufacture.repair import Repair, RepairKind
from .evidence import RepairEvidence


def hollow_out(evidence: RepairEvidence, plan: Plan) -> Plan | None:
    """Return every part that is rejected because nobody gets into it, once each.

    Other hulls are cut apart anew: thin walls need less room than what filled them.
    """
    filled = {
        part for each in evidence.hard if each.code == "interior_filled" for part in each.parts
    }
    new = frozenset(filled) - plan.hollow
    if not new:
        return None
    left = Repair(RepairKind.LEFT_HOLLOW, parts=tuple(sorted(new)))
    return replace(plan, hollow=plan.hollow | new, repairs=(*plan.repairs, left))
