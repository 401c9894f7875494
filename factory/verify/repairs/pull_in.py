"""A joint whose closed end lies in something begins where it is free, no further than as shown."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...articulation import Joint
from ...asset import Asset
from ...manufacture.plan import Plan
from ...manufacture.repair import RepairKind
from ...manufacture.separate.sweep import swept_m
from .evidence import RepairEvidence, record_change

#: Values between the lower limit and the pose as modelled that are tried as a new lower limit.
TRIED = 9
#: What is no deeper than this is no penetration [m].
FREE_M = 0.0005


def pull_in(evidence: RepairEvidence, plan: Plan) -> Plan | None:
    """Lower limits below the pose as modelled, of parts that lie in another one there."""
    asset = evidence.asset
    if asset is None or "rest_penetration" not in evidence.codes:
        return None
    stuck = {
        part for each in evidence.errors if each.code == "rest_penetration" for part in each.parts
    }
    lower = dict(plan.lower)
    repairs = list(plan.repairs)
    for joint in asset.articulation.movable_joints:
        child = asset.articulation.parts[joint.child].name
        if joint.name in plan.lower or child not in stuck or not joint.lower < 0.0:
            continue
        begins = _free_from(asset, joint, evidence.config.least_range_share)
        if begins is not None:
            lower[joint.name] = begins
            kind = RepairKind.CLOSED_END_PULLED_IN
            repairs.append(record_change(kind, joint.name, joint.lower, begins, joint.unit))
    return None if lower == plan.lower else replace(plan, lower=lower, repairs=tuple(repairs))


def _free_from(asset: Asset, joint: Joint, least_share: float) -> float | None:
    """Return the lowest limit towards which nothing gets deeper; ``None`` if there is none."""
    hulls = [body.hulls for body in asset.bodies]
    for value in np.linspace(joint.lower, 0.0, TRIED + 1)[1:]:
        if (joint.upper - value) < least_share * joint.range:
            return None
        # From the pose as modelled down to the limit: what lies in something there gets deeper.
        down = replace(joint, axis=-joint.axis, lower=0.0, upper=-float(value))
        if value == 0.0 or swept_m(asset.articulation, hulls, down, FREE_M) <= FREE_M:
            return float(value)
    return None
