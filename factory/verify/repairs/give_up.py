"""A guessed part that cannot be a part of its own is none: the guess that is worth least goes."""

from __future__ import annotations

from asset_factory.sim_checks import Finding

from ...manufacture.plan import Plan
from ...manufacture.repair import Repair, RepairKind
from .evidence import RepairEvidence

#: What may go with a guess though it does not name it: what lies how, and what else is in the way.
MAY_GO = frozenset({"sweep_penetration", "collision_gap", "interior_filled"})
#: What a wrong guess brings about.
BY_A_GUESS = MAY_GO | {
    "rest_penetration", "jammed", "not_returned", "limit_overshoot", "others_moved",
    "pushed_at_rest", "energy_grows", "part_detached",
}  # fmt: skip


def give_up_guesses(evidence: RepairEvidence, plan: Plan) -> Plan | None:
    """Give up, of two parts that overlap at rest, the one worth less; else the guess worth least.

    Nothing where a finding names no guess that could go.
    """
    if evidence.codes <= {"sweep_penetration"} or not evidence.codes <= BY_A_GUESS:
        return None
    overlapping = [finding for finding in evidence.errors if finding.code == "rest_penetration"]
    going: dict[str, Finding] = {}
    for finding in evidence.errors:
        doubtful = _named(finding, evidence)
        if not doubtful and finding.code not in MAY_GO:
            return None
        if doubtful and (finding in overlapping or not overlapping):
            going.setdefault(doubtful[0], finding)
    if not overlapping:
        least = next((part for part in evidence.spare.guesses if part in going), None)
        going = {least: going[least]} if least is not None else {}
    return _without(plan, going, evidence)


def _named(finding: Finding, evidence: RepairEvidence) -> list[str]:
    """Return the guessed parts that a finding is about, by part or by joint, worth least first."""
    joints = {finding.joint, *finding.joints}
    guesses = evidence.spare.guesses.items()
    return [part for part, joint in guesses if part in finding.parts or joint in joints]


def _without(plan: Plan, going: dict[str, Finding], evidence: RepairEvidence) -> Plan | None:
    guesses = evidence.spare.guesses
    repairs = [
        _given_up(guesses[part], part, finding)
        for part, finding in going.items()
        if guesses[part] not in plan.given_up
    ]
    if not repairs:
        return None
    given_up = plan.given_up.union(*(repair.joints for repair in repairs))
    gone = {part for part, joint in guesses.items() if joint in given_up}
    return plan.repaired(
        *repairs,
        separate=frozenset(filter(gone.isdisjoint, plan.separate)),
        exclude=frozenset(filter(gone.isdisjoint, plan.exclude)),
        given_up=given_up,
    )


def _given_up(joint: str, part: str, finding: Finding) -> Repair:
    overlaps = finding.code == "rest_penetration"
    kind = RepairKind.OVERLAPPING_GIVEN_UP if overlaps else RepairKind.JOINT_GIVEN_UP
    others = [other for other in finding.parts if overlaps and other != part]
    return Repair(kind, (part, *others), joints=(joint,), code=finding.code, why=finding.message)
