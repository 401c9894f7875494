"""A guessed hinge whose door swings into its frame goes to the door's front edge."""

from dataclasses import replace

from ...manufacture.plan import Plan
from ...manufacture.repair import Repair, RepairKind
from .evidence import RepairEvidence


def rehang_doors(evidence: RepairEvidence, plan: Plan) -> Plan | None:
    """Return all blocked hinges that were guessed, once each."""
    if "sweep_penetration" not in evidence.codes:
        return None
    blocked = {joint.joint for joint in evidence.joints() if joint.clear_until is not None}
    new = (blocked & evidence.spare.hinges) - plan.rehung
    if not new:
        return None
    moved = Repair(RepairKind.GUESSED_HINGE_MOVED, joints=tuple(sorted(new)))
    return replace(plan, rehung=plan.rehung | new, repairs=(*plan.repairs, moved))
