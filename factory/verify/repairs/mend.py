"""A joint that is slightly wrong: turned round, straightened, or hung at its panel's edge."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ...articulation import Articulation, Joint, JointKind
from ...asset import Asset
from ...manufacture.hinges import at_back_edge, at_front_edge, is_askew
from ...manufacture.plan import Plan
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

#: What is told, the joint, and how deep it may drive hulls into one another [m].
Change = tuple[str, Joint, float]


def mend_joints(evidence: RepairEvidence, plan: Plan) -> Plan | None:
    """Return every blocked joint that one small change lets go all its way, once each.

    The change is made only if nothing gets deeper along the whole range by it; beside a hinge at
    an edge, no more than may be planed off there.
    """
    asset = evidence.asset
    if asset is None or "sweep_penetration" not in evidence.codes:
        return None
    joints = dict(plan.mended)
    steps = list(plan.steps)
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
            told, joints[joint.name] = found
            steps.append(f"mended {joint.name}: {told}; it ran into something after {share:.0%}")
    if len(joints) == len(plan.mended):
        return None
    return replace(plan, mended=joints, steps=tuple(steps))


def _freed(asset: Asset, joint: Joint, share: float) -> tuple[str, Joint] | None:
    """The first change by which the joint is free all along, else that which leaves least."""
    hulls = [body.hulls for body in asset.bodies]
    least = np.inf
    best = None
    for told, changed, most_m in _changes(asset.articulation, joint, share):
        swept = swept_m(asset.articulation, hulls, changed, most_m)
        if swept <= FREE_M:
            return told, changed
        if swept <= most_m and swept < least:
            least = swept
            best = told, changed
    return best


def _changes(articulation: Articulation, joint: Joint, share: float) -> Iterator[Change]:
    """Small changes, the least first."""
    straight = _straightened(joint)
    if straight is not None:
        angle = float(np.degrees(np.arccos(min(1.0, float(straight.axis @ joint.axis)))))
        yield f"its axis was {angle:.1f} degrees off a principal direction", straight, FREE_M
    # An axis that is off is not left so for the sake of another change.
    base = straight or joint
    for edge, hung in _rehung(articulation, base):
        moved = 1000.0 * float(np.linalg.norm(hung.origin - joint.origin))
        yield f"its hinge was {moved:.1f} mm off its panel's {edge} edge", hung, PLANED_M
    if share < BLOCKED_SHARE and joint.lower == 0.0:
        yield "it opened inwards and is turned round", replace(base, axis=-base.axis), FREE_M


def _straightened(joint: Joint) -> Joint | None:
    if not is_askew(joint.axis):
        return None
    longest = int(np.abs(joint.axis).argmax())
    direction: FloatArray = np.eye(3)[longest] * np.sign(joint.axis[longest])
    return replace(joint, axis=direction)


def _rehung(articulation: Articulation, joint: Joint) -> Iterator[tuple[str, Joint]]:
    """Yield a hinge at the edges of its part that are near, and which they are."""
    if joint.kind is not JointKind.REVOLUTE:
        return
    most = MOVED_SHARE * articulation.part_mesh(joint.child).diagonal
    for edge, at_edge in (("front", at_front_edge), ("back", at_back_edge)):
        hung = at_edge(articulation, joint)
        if hung is not None and float(np.linalg.norm(hung.origin - joint.origin)) <= most:
            yield edge, hung
