"""Front plates that stick in what is around them are built anew, with room for each."""

from __future__ import annotations

from dataclasses import replace

from ...manufacture.plan import Plan
from ...manufacture.repair import Repair, RepairKind
from .evidence import RepairEvidence

#: What says that parts are in one another's way.
STUCK = frozenset({"rest_penetration", "sweep_penetration", "interior_filled"})


def build_fronts(evidence: RepairEvidence, plan: Plan) -> Plan | None:
    """Return all thin fronts, once, where one of them is rejected for sticking in something."""
    if plan.build_fronts or not evidence.spare.fronts:
        return None
    stuck = [finding for finding in evidence.hard if finding.code in STUCK]
    if not stuck:
        return None
    built = Repair(RepairKind.FRONTS_BUILT, parts=tuple(sorted(evidence.spare.fronts)))
    return replace(
        plan,
        build_fronts=True,
        separate=frozenset(),
        exclude=frozenset(),
        repairs=(*plan.repairs, built),
    )
