"""A joint that is slightly wrong: turned round, straightened, hung elsewhere, or closed too far."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from asset_factory.sim_checks.geometry.boxy import edge_meant

from ...articulation import Articulation, Joint, JointKind
from ...asset import Asset
from ...manufacture.hinges import STRAIGHT, at_back_edge, at_front_edge, is_askew
from ...manufacture.plan import Plan
from ...manufacture.repair import Repair, RepairKind
from ...manufacture.separate.sweep import swept_m
from ...mesh import FloatArray
from .evidence import RepairEvidence, record_change
from .shorten import SHORTER

#: A hinge may be moved by this share of its part's diagonal.
MOVED_SHARE = 0.06
#: A joint that runs into something within this share of its range may run the wrong way.
BLOCKED_SHARE = 0.25
#: What is no deeper than this is no penetration [m].
FREE_M = 0.0005
#: What a hinge at an edge leaves in the way the cut that follows may plane off, for hulls were cut
#: apart for another axis [m].
PLANED_M = 0.013
#: Values between the lower limit and the pose as modelled that are tried as a new lower limit.
TRIED = 9
#: Kinds that move a hinge to an edge.
TO_EDGE = {
    RepairKind.HINGE_TO_FRONT_EDGE: at_front_edge,
    RepairKind.HINGE_TO_BACK_EDGE: at_back_edge,
}
#: Kinds that hang a hinge elsewhere, or as its neighbour.
HUNG = frozenset({*TO_EDGE, RepairKind.HINGE_TO_LINE, RepairKind.REVERSED_TOO})


@dataclass(frozen=True)
class Mended:
    """A joint as it should have been.

    Attributes:
        joint: with another axis, or elsewhere.
        repair: that made it so.
        ended: what ended it early besides; ``None`` where it goes all its way.
        left_m: how much deeper than at rest it still gets [m].
    """

    joint: Joint
    repair: Repair
    ended: Repair | None = None
    left_m: float = 0.0


def rehang_doors(evidence: RepairEvidence, plan: Plan) -> Plan | None:
    """Return all blocked hinges that were guessed at the front edges of their doors, once each."""
    if "sweep_penetration" not in evidence.codes:
        return None
    new = (evidence.jammed().keys() & evidence.spare.hinges) - plan.rehung
    moved = Repair(RepairKind.GUESSED_HINGE_MOVED, joints=tuple(sorted(new)))
    return plan.repaired(moved, rehung=plan.rehung | new) if new else None


def square_axes(evidence: RepairEvidence, plan: Plan) -> Plan | None:
    """Turn hinges that are askew to the box that they turn along its nearest edge, once each."""
    articulation = evidence.asset.articulation
    found = []
    askew = {each.joint or "" for each in evidence.found("axis_oblique")}
    for name in sorted(askew - plan.mended.keys()):
        joint = articulation.joint(name)
        part = articulation.part_mesh(joint.child)
        edge = edge_meant(part.vertices, part.faces, joint.axis)
        if edge is not None:
            found.append(_turned_to(RepairKind.AXIS_SQUARED, joint, edge))
    return with_mended(plan, found)


def pull_in(evidence: RepairEvidence, plan: Plan) -> Plan | None:
    """Raise lower limits below the pose as modelled, of parts that lie in another one there.

    A joint whose closed end lies in something begins where it is free, no further than as shown.
    """
    asset = evidence.asset
    stuck = evidence.wrong_parts("rest_penetration")
    lower = dict(plan.lower)
    repairs = []
    for joint in asset.articulation.movable_joints:
        child = asset.articulation.parts[joint.child].name
        if joint.name in plan.lower or child not in stuck or not joint.lower < 0.0:
            continue
        begins = _free_from(asset, joint, evidence.config.least_range_share)
        if begins is not None:
            lower[joint.name] = begins
            kind = RepairKind.CLOSED_END_PULLED_IN
            repairs.append(record_change(kind, joint, joint.lower, begins))
    return plan.repaired(*repairs, lower=lower) if repairs else None


def mend_joints(evidence: RepairEvidence, plan: Plan) -> Plan | None:
    """Return every blocked joint that one small change lets go all its way, once each.

    The change is made only if nothing gets deeper along the whole range by it; beside a hinge that
    is hung elsewhere, no more than may be planed off there. One that its own part's edges do not
    free goes to the line of another hinge of the same part, if that leaves less; and one that is
    blocked too soon to be ended there is changed and ended.
    """
    asset = evidence.asset
    if "sweep_penetration" not in evidence.codes:
        return None
    shares = {
        name: (until - measured.lower) / (measured.upper - measured.lower)
        for name, (measured, until) in evidence.jammed().items()
    }
    joints = [asset.articulation.joint(name) for name in shares if name not in plan.mended]
    # Guesses are hung anew by those who made them.
    blocked = [joint for joint in joints if joint.confidence is None]
    found: dict[str, Mended] = {}
    for joint in blocked:
        # A button is pressed into its panel: it is small, and never turned round.
        share = 1.0 if joint.name in evidence.spare.joints else shares[joint.name]
        change = _freed(asset, _changes(asset.articulation, joint, share))
        if change is not None:
            found[joint.name] = change
    straight = [j for j in asset.articulation.joints if j.name not in shares]
    for joint in blocked:
        own = found.get(joint.name)
        if own is not None and own.left_m <= FREE_M:
            continue
        lines = [*straight, *(one.joint for name, one in found.items() if name != joint.name)]
        others = list(_at_lines(asset.articulation, joint, lines))
        if shares[joint.name] < BLOCKED_SHARE and joint.lower == 0.0:
            others += _turned_as(asset.articulation, joint, lines)
        options = [each for each in (own, _freed(asset, others)) if each is not None]
        change = min(options, key=lambda each: each.left_m, default=None)
        least = evidence.config.least_range_share
        stuck = shares[joint.name] < least and joint.name not in evidence.spare.joints
        if change is None and stuck:
            small = _changes(asset.articulation, joint, share=1.0)
            change = _freed_early(asset, [*small, *others], least)
        if change is not None:
            found[joint.name] = change
    told = {name: replace(one.repair, free_share=shares[name]) for name, one in found.items()}
    return with_mended(plan, [replace(one, repair=told[name]) for name, one in found.items()])


def _free_from(asset: Asset, joint: Joint, least_share: float) -> float | None:
    """Return the lowest limit towards which nothing gets deeper; ``None`` if there is none."""
    for value in np.linspace(joint.lower, 0.0, TRIED + 1)[1:]:
        if (joint.upper - value) < least_share * joint.range:
            return None
        # From the pose as modelled down to the limit: what lies in something there gets deeper.
        down = replace(joint, axis=-joint.axis, lower=0.0, upper=-float(value))
        if value == 0.0 or swept_m(asset, down, FREE_M) <= FREE_M:
            return float(value)
    return None


def with_mended(plan: Plan, found: Sequence[Mended]) -> Plan | None:
    """Return the plan with the joints that were mended, and ended besides, if there are any."""
    if not found:
        return None
    return plan.repaired(
        *(one.repair for one in found),
        *(one.ended for one in found if one.ended),
        mended={**plan.mended, **{one.joint.name: one.joint for one in found}},
        upper={**plan.upper, **{one.joint.name: one.joint.upper for one in found if one.ended}},
    )


def _freed(asset: Asset, changes: Iterable[Mended]) -> Mended | None:
    """Return the first change that frees the joint all along, else the one that leaves least."""
    best = None
    for change in changes:
        most_m = PLANED_M if change.repair.kind in HUNG else FREE_M
        left_m = swept_m(asset, change.joint, most_m)
        if left_m <= FREE_M:
            return change
        if left_m <= most_m and (best is None or left_m < best.left_m):
            best = replace(change, left_m=left_m)
    return best


def _freed_early(asset: Asset, changes: Iterable[Mended], least_share: float) -> Mended | None:
    """Return the change that frees the joint furthest, ended there; ``None`` if not far enough."""
    changes = list(changes)
    for share in SHORTER:
        for change in changes if share >= least_share else ():
            joint = change.joint
            shorter = replace(joint, upper=joint.lower + share * joint.range)
            if shorter.upper >= 0.0 and swept_m(asset, shorter, FREE_M) <= FREE_M:
                kind = RepairKind.RANGE_SHORTENED
                ended = record_change(kind, joint, joint.upper, shorter.upper)
                return replace(change, joint=shorter, ended=ended)
    return None


def _changes(articulation: Articulation, joint: Joint, share: float) -> Iterator[Mended]:
    """Yield small changes, the least first."""
    # An axis that is off is not left so for the sake of another change.
    base = joint
    if is_askew(joint.axis):
        longest = int(np.abs(joint.axis).argmax())
        axis = np.eye(3)[longest] * np.sign(joint.axis[longest])
        straight = _turned_to(RepairKind.AXIS_STRAIGHTENED, joint, axis)
        base = straight.joint
        yield straight
    for kind, at_edge in TO_EDGE.items():
        hung = at_edge(articulation, base)
        if hung is not None:
            yield from _moved_to(articulation, kind, joint, hung)
    if share < BLOCKED_SHARE and joint.lower == 0.0:
        turned = replace(base, axis=-base.axis)
        yield Mended(turned, Repair(RepairKind.OPENING_REVERSED, joints=(joint.name,)))


def _turned_to(kind: RepairKind, joint: Joint, axis: FloatArray) -> Mended:
    """Return a joint about another axis, and by how much that turned it [deg]."""
    off = float(np.degrees(np.arccos(min(1.0, float(axis @ joint.axis)))))
    return Mended(replace(joint, axis=axis), record_change(kind, joint, off, 0.0, "deg"))


def _at_lines(articulation: Articulation, joint: Joint, lines: Iterable[Joint]) -> Iterator[Mended]:
    """Yield a hinge at the lines of others of the same part that it is nearly at."""
    for line in lines:
        cosine = float(line.axis @ joint.axis)
        hinges = joint.kind is JointKind.REVOLUTE is line.kind
        if not hinges or line.parent != joint.parent or abs(cosine) < STRAIGHT:
            continue
        along = line.axis * float(line.axis @ (joint.origin - line.origin))
        axis = line.axis * np.sign(cosine)
        hung = replace(joint, axis=axis, origin=line.origin + along)
        yield from _moved_to(articulation, RepairKind.HINGE_TO_LINE, joint, hung)


def _turned_as(
    articulation: Articulation, joint: Joint, lines: Iterable[Joint]
) -> Iterator[Mended]:
    """Yield a hinge turned round, where another at its line opens the other way."""
    against = (line for line in lines if float(line.axis @ joint.axis) < 0.0)
    if any(_at_lines(articulation, joint, against)):
        turned = replace(joint, axis=-joint.axis)
        yield Mended(turned, Repair(RepairKind.REVERSED_TOO, joints=(joint.name,)))


def _moved_to(
    articulation: Articulation, kind: RepairKind, joint: Joint, hung: Joint
) -> Iterator[Mended]:
    """Yield a hinge that is hung elsewhere, if no further off than its part's size lets it be."""
    moved = float(np.linalg.norm(hung.origin - joint.origin))
    if moved <= MOVED_SHARE * articulation.part_mesh(joint.child).diagonal:
        yield Mended(hung, record_change(kind, joint, 1000.0 * moved, 0.0, "mm"))
