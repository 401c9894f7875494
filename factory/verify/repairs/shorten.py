"""A joint that runs into something ends before it, or is fixed where the object can do without."""

from __future__ import annotations

from dataclasses import replace

from ...articulation import Joint
from ...asset import Asset
from ...manufacture.plan import Plan
from ...manufacture.repair import Repair, RepairKind
from ...manufacture.separate.along import LEAST_M
from ...manufacture.separate.sweep import swept_m
from .evidence import RepairEvidence, record_change
from .give_up import BY_A_GUESS

#: Shares of the way to where a joint fails that are tried as its end, the longest first.
SHORTER = (0.98, 0.95, 0.9, 0.85, 0.8, 0.7, 0.6, 0.5)
#: What is no deeper than this is no penetration [m].
FREE_M = 1e-4


def shorten_or_freeze(evidence: RepairEvidence, plan: Plan) -> Plan | None:
    """Return every blocked joint shortened or frozen; nothing if one can be neither."""
    if not evidence.codes or not evidence.codes <= {"sweep_penetration", "joint_obstructed"}:
        return None
    upper = dict(plan.upper)
    frozen = set(plan.frozen)
    repairs = []

    for name, (measured, until) in evidence.blocked().items():
        joint = evidence.asset.articulation.joint(name)
        free = _free_end(evidence.asset, joint, until)
        end = until if free is None else free
        share = (end - measured.lower) / (measured.upper - measured.lower)
        # What is never clear of anything jams wherever it ends; it goes if it can be spared.
        ends = free is not None or name not in evidence.spare.joints
        long_enough = share >= evidence.config.least_range_share
        # Nor may it end before the pose as modelled.
        if name not in plan.upper and ends and end >= 0.0 and long_enough:
            upper[name] = end
            repairs.append(record_change(RepairKind.RANGE_SHORTENED, joint, measured.upper, end))
        elif name in evidence.spare.joints:
            frozen.add(name)
            repairs.append(Repair(RepairKind.JOINT_FROZEN, joints=(name,), free_share=share))
        else:
            return None

    return plan.repaired(*repairs, upper=upper, frozen=frozenset(frozen)) if repairs else None


def freeze_small(evidence: RepairEvidence, plan: Plan) -> Plan | None:
    """Return the small joints fixed to what carries them, if nothing else is wrong."""
    tree = evidence.asset.articulation
    spare = evidence.spare.joints - plan.frozen
    # Guesses are given up by who is less sure.
    stated = [joint for joint in tree.joints if joint.confidence is None and joint.name in spare]
    frozen: dict[str, Repair] = {}
    for finding in evidence.errors:
        about = [
            joint.name
            for joint in stated
            if joint.name == finding.joint
            or (finding.joint is None and tree.parts[joint.child].name in finding.parts)
        ]
        if not about or finding.code not in BY_A_GUESS:
            return None
        for name in about:
            told = Repair(
                RepairKind.JOINT_FROZEN, joints=(name,), code=finding.code, why=finding.message
            )
            frozen.setdefault(name, told)
    return plan.repaired(*frozen.values(), frozen=plan.frozen | frozen.keys()) if frozen else None


def _free_end(asset: Asset, joint: Joint, clear_until: float) -> float | None:
    """Return where a joint still touches nothing, before it fails; ``None`` if that is nowhere."""
    for share in SHORTER:
        shorter = replace(joint, upper=joint.lower + share * (clear_until - joint.lower))
        # The pose as modelled is never left out.
        if shorter.upper < 0.0 or shorter.range <= 0.0:
            continue
        if swept_m(asset, shorter, FREE_M, LEAST_M) <= FREE_M:
            return shorter.upper
    return None
