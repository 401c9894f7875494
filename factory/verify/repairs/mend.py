"""A joint that is slightly wrong: turned round, straightened, or hung at its panel's edge."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ...articulation import Articulation, Joint, JointKind
from ...asset import Asset
from ...manufacture.hinges import at_back_edge, at_front_edge, is_askew
from ...manufacture.plan import Plan
from ...manufacture.repair import Repair, RepairKind
from ...manufacture.separate.sweep import swept_m
from ...mesh import FloatArray
from .evidence import RepairEvidence

#: A hinge may be moved by this share of its part's diagonal.
MOVED_SHARE = 0.06
#: A joint that runs into something within this share of its range may run the wrong way.
BLOCKED_SHARE = 0.25
#: What is no deeper than this is no penetration [m].
FREE_M = 0.0005
#: What a hinge at an edge leaves in the way the cut that follows may plane off, for hulls were cut
#: apart for another axis [m].
PLANED_M = 0.013
#: Kinds that move a hinge to an edge.
TO_EDGE = {
    RepairKind.HINGE_TO_FRONT_EDGE: at_front_edge,
    RepairKind.HINGE_TO_BACK_EDGE: at_back_edge,
}


def mend_joints(evidence: RepairEvidence, plan: Plan) -> Plan | None:
    """Return every blocked joint that one small change lets go all its way, once each.

    The change is made only if nothing gets deeper along the whole range by it; beside a hinge at
    an edge, no more than may be planed off there.
    """
    asset = evidence.asset
    if asset is None or "sweep_penetration" not in evidence.codes:
        return None
    joints = dict(plan.mended)
    repairs = list(plan.repairs)
    for measured in evidence.joints():
        if measured.clear_until is None or measured.joint in plan.mended:
            continue
        joint = asset.articulation.joint(measured.joint)
        # Guesses are hung anew by those who made them.
        if joint.confidence is not None:
            continue
        share = (measured.clear_until - measured.lower) / (measured.upper - measured.lower)
        # A button is pressed into its panel: it is small, and never turned round.
        small = joint.name in evidence.spare.joints
        found = _freed(asset, joint, 1.0 if small else share)
        if found is not None:
            joints[joint.name], repair = found
            repairs.append(replace(repair, free_share=share))
    if len(joints) == len(plan.mended):
        return None
    return replace(plan, mended=joints, repairs=tuple(repairs))


def _freed(asset: Asset, joint: Joint, share: float) -> tuple[Joint, Repair] | None:
    """Return the first change that frees the joint all along, else the one that leaves least."""
    hulls = [body.hulls for body in asset.bodies]
    least = np.inf
    best = None
    for changed, repair in _changes(asset.articulation, joint, share):
        most_m = PLANED_M if repair.kind in TO_EDGE else FREE_M
        swept = swept_m(asset.articulation, hulls, changed, most_m)
        if swept <= FREE_M:
            return changed, repair
        if swept <= most_m and swept < least:
            least = swept
            best = changed, repair
    return best


def _changes(
    articulation: Articulation, joint: Joint, share: float
) -> Iterator[tuple[Joint, Repair]]:
    """Yield small changes, the least first."""
    names = (joint.name,)
    straight = _straightened(joint)
    if straight is not None:
        angle = float(np.degrees(np.arccos(min(1.0, float(straight.axis @ joint.axis)))))
        kind = RepairKind.AXIS_STRAIGHTENED
        yield straight, Repair(kind, joints=names, before=angle, after=0.0, unit="deg")
    # An axis that is off is not left so for the sake of another change.
    base = straight or joint
    for kind, hung in _rehung(articulation, base):
        moved = 1000.0 * float(np.linalg.norm(hung.origin - joint.origin))
        yield hung, Repair(kind, joints=names, before=moved, after=0.0, unit="mm")
    if share < BLOCKED_SHARE and joint.lower == 0.0:
        turned = replace(base, axis=-base.axis)
        yield turned, Repair(RepairKind.OPENING_REVERSED, joints=names)


def _straightened(joint: Joint) -> Joint | None:
    if not is_askew(joint.axis):
        return None
    longest = int(np.abs(joint.axis).argmax())
    direction: FloatArray = np.eye(3)[longest] * np.sign(joint.axis[longest])
    return replace(joint, axis=direction)


def _rehung(articulation: Articulation, joint: Joint) -> Iterator[tuple[RepairKind, Joint]]:
    """Yield a hinge at near edges of its part, and the repair that moves it there."""
    if joint.kind is not JointKind.REVOLUTE:
        return
    most = MOVED_SHARE * articulation.part_mesh(joint.child).diagonal
    for kind, at_edge in TO_EDGE.items():
        hung = at_edge(articulation, joint)
        if hung is not None and float(np.linalg.norm(hung.origin - joint.origin)) <= most:
            yield kind, hung
