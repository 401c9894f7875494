"""Repairs that change collision geometry only: joints and parts stay as they were stated."""

from __future__ import annotations

from ...manufacture.plan import Plan
from ...manufacture.repair import Repair, RepairKind
from .evidence import RepairEvidence, ordered


def separate_hulls(evidence: RepairEvidence, plan: Plan) -> Plan | None:
    """Cut hulls that nearly touch apart, once, even where validation lets them: engines do not."""
    near = {
        ordered(*contact.links)
        for measured in evidence.measured
        for contact in measured.contacts
        if contact.depth_mm > -evidence.config.near_mm
    }
    new = frozenset(near) - plan.separate
    cut = Repair(RepairKind.HULLS_CUT_APART, pairs=tuple(sorted(new)))
    return plan.repaired(cut, separate=plan.separate | new) if new else None


def exclude_knuckles(evidence: RepairEvidence, plan: Plan) -> Plan | None:
    """Exclude what still overlaps at a hinge's knuckle from contact, as other engines do anyway."""
    found = {ordered(*f.parts) for f in evidence.found("hinge_overlap") if len(f.parts) == 2}
    new = frozenset(found) - plan.exclude
    excluded = Repair(RepairKind.CONTACT_EXCLUDED, pairs=tuple(sorted(new)))
    return plan.repaired(excluded, exclude=plan.exclude | new) if new else None


def fit_closely(evidence: RepairEvidence, plan: Plan) -> Plan | None:
    """Leave hulls that were joined to be fewer, and are in the way now, as they were decomposed.

    Not where hulls were joined because the asset had too many.
    """
    if plan.closely or plan.fewer is not None:
        return None
    joined = {part for each in evidence.found("hulls_joined") for part in each.parts}
    if not any(joined.intersection(each.parts or joined) for each in evidence.errors):
        return None
    left = Repair(RepairKind.HULLS_NOT_JOINED, parts=tuple(sorted(joined)))
    return plan.repaired(left, closely=True)


def build_fronts(evidence: RepairEvidence, plan: Plan) -> Plan | None:
    """Rebuild front plates that stick in their surroundings, once, with room for each."""
    if plan.build_fronts or not evidence.spare.fronts:
        return None
    if evidence.codes.isdisjoint({"rest_penetration", "sweep_penetration", "interior_filled"}):
        return None
    built = Repair(RepairKind.FRONTS_BUILT, parts=tuple(sorted(evidence.spare.fronts)))
    return plan.repaired(built, build_fronts=True, separate=frozenset(), exclude=frozenset())


def hollow_out(evidence: RepairEvidence, plan: Plan) -> Plan | None:
    """Make a part that its own hulls fill again as what it shows: walls around nothing.

    Other hulls are cut apart anew: thin walls need less room than what filled them.
    """
    new = evidence.wrong_parts("interior_filled") - plan.hollow
    left = Repair(RepairKind.LEFT_HOLLOW, parts=tuple(sorted(new)))
    return plan.repaired(left, hollow=plan.hollow | new) if new else None
