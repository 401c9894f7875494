"""A joint that runs into something ends before it, or is fixed where the object can do without."""

from __future__ import annotations

from dataclasses import replace

from ...manufacture.plan import Plan
from .evidence import RepairEvidence


def shorten_or_freeze(evidence: RepairEvidence, plan: Plan) -> Plan | None:
    """Every blocked joint shortened or frozen; nothing if one can be neither."""
    if evidence.codes != {"sweep_penetration"}:
        return None
    upper = dict(plan.upper)
    frozen = set(plan.frozen)
    steps = list(plan.steps)

    for joint in evidence.joints():
        if joint.clear_until is None:
            continue
        share = (joint.clear_until - joint.lower) / (joint.upper - joint.lower)
        if joint.joint not in plan.upper and share >= evidence.config.least_range_share:
            upper[joint.joint] = joint.clear_until
            steps.append(
                f"ended {joint.joint} at {joint.clear_until:.4g} instead of {joint.upper:.4g} "
                f"{joint.unit}: it runs into something there"
            )
        elif joint.joint in evidence.spare.joints:
            frozen.add(joint.joint)
            steps.append(
                f"froze {joint.joint}: it runs into something after {share:.0%} of its range"
            )
        else:
            return None

    changed = replace(plan, upper=upper, frozen=frozenset(frozen), steps=tuple(steps))
    return changed if changed != plan else None
