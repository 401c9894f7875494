"""What the penetration check measured, as findings and as JSON data."""

from __future__ import annotations

from collections.abc import Iterable, Sequence, Set
from dataclasses import replace
from typing import Any

from ..config import PenetrationConfig
from ..measurements import (
    MeasuredCombination,
    MeasuredContact,
    MeasuredJoint,
    MeasuredNeighbour,
    MeasuredPair,
    MeasuredPenetration,
)
from ..report import Finding
from .cause import CLAUSES
from .pairs import RestingSolids
from .penetration_study import (
    BothOpen,
    Contact,
    JointSweep,
    Neighbours,
    PairKind,
    PairSweep,
    PartPair,
    PenetrationStudy,
)
from .result import CheckResult, Findings, graded, in_mm, note

_EXCLUDED = ", but the file excludes this pair from contact"
#: Of pairs that may overlap: how that is told, and why it may.
EXEMPT = {
    PairKind.HINGE: ("hinge_overlap", ", but this is the knuckle of their hinge"),
    PairKind.EXCLUDED: ("excluded_penetration", _EXCLUDED),
}


def report(study: PenetrationStudy, rest: RestingSolids) -> CheckResult:
    """Return findings in the order rest, joints, neighbours, combinations; and every number.

    The measurements are plain JSON data. Wherever two parts were found to meet, ``visual_mm`` says
    how their visible surfaces stand there (a positive gap, at most the clearance that is measured,
    or a negative depth; null where it was not measured) and ``cause`` why, where that can be told.
    ``visual_clearance_mm`` of a joint is the same where its hulls come nearest. ``needs_open`` of a
    joint names those that must be open before it, in the order in which they open, and
    ``waits_for`` those that would have to be and never are. ``neighbours`` holds what joints do
    while another stands open, at ``open_at``.
    """
    config = rest.config
    findings = [*_rest_findings(study, config)]
    for sweep in study.sweeps:
        findings += _sweep_findings(sweep, config)
    colliding = [item for item in study.neighbours.met if item.pair.excess > config.excess_m]
    findings += (_both_open(item, config) for item in colliding)
    findings += _left_out(study.neighbours, config)
    told = told_parts(study.sweeps, config) | {item.pair.parts for item in colliding}
    findings += _combination_findings(study, config, told)
    return CheckResult(tuple(findings), measured(study, rest).to_dict())


def told_parts(sweeps: Sequence[JointSweep], config: PenetrationConfig) -> frozenset[PartPair]:
    """Return the pairs of parts that meet too deeply while all joints but one are closed."""
    return frozenset(p.parts for each in sweeps for p in each.pairs if p.excess > config.excess_m)


def _rest_findings(study: PenetrationStudy, config: PenetrationConfig) -> Findings:
    again = {contact.parts: contact.depth + config.excess_m for contact in study.rest}
    found = [("with every joint at its lower limit", each) for each in study.rest]
    for contact in study.zero or ():
        if contact.depth > again.get(contact.parts, config.excess_m):
            found.append(("with every joint at 0", contact))
    for pose, contact in found:
        if contact.depth <= config.rest_m:
            continue
        code, why = EXEMPT.get(contact.kind, ("rest_penetration", ""))
        a, b = contact.links
        message = (
            f"{a} and {b} overlap by {mm(contact.depth):.2f} mm "
            f"{pose}{_near(contact)}; at most {mm(config.rest_m):g} mm is allowed{why}"
        )
        grave = contact.kind is PairKind.PLAIN
        yield _finding(grave, code, message, contact, contact.depth, config.rest_m)


def _sweep_findings(sweep: JointSweep, config: PenetrationConfig) -> Findings:
    joint = sweep.joint.name
    unit = sweep.joint.unit
    for pair in sweep.pairs:
        if pair.excess <= config.excess_m:
            continue
        a, b = pair.links
        depth = mm(pair.excess)
        grave = pair.kind is PairKind.PLAIN
        code, why = EXEMPT.get(pair.kind, ("sweep_penetration", ""))
        message = (
            f"as {joint} moves, {a} and {b} penetrate {depth:.2f} mm deeper than "
            f"at rest, worst at {pair.at:.4g} {unit}{_near(pair)}; "
            f"at most {mm(config.excess_m):g} mm is allowed{why}"
        )
        if grave and sweep.alternative is not None:
            grave = False
            code = "joint_dependency"
            message = (
                f"{joint} is blocked while other joints are at their lower limits: "
                f"{a} and {b} would penetrate {depth:.2f} mm at {pair.at:.4g} {unit}; "
                f"with {' and '.join(sweep.needs_open)} open its way is free"
            )
        elif grave and sweep.waits_for:
            message += f"; {' and '.join(sweep.waits_for)} would have to make way, but never opens"
        found = _finding(grave, code, message, pair, pair.excess, config.excess_m)
        yield replace(found, joint=joint)


def _finding(
    grave: bool, code: str, message: str, contact: Contact, depth: float, most: float
) -> Finding:
    """Return what there is to say of a contact that is deeper than the most allowed [m]."""
    cause = None if contact.cause is None else str(contact.cause)
    if contact.cause is not None:
        message += f"; {CLAUSES[contact.cause]}"
    return graded(grave, code, message, parts=contact.links, **in_mm(depth, most), cause=cause)


def _both_open(item: BothOpen, config: PenetrationConfig) -> Finding:
    """Return what two joints do that run parts into each other when both are open."""
    pair = item.pair
    joint = item.joint.name
    other = item.other.name
    unit = item.joint.unit
    stands = f"{other} at {item.other_at:.4g} {item.other.unit}"
    a, b = pair.links
    depth = f"{a} and {b} penetrate {mm(pair.excess):.2f} mm deeper than at rest"
    if item.obstructed:
        code = "joint_obstructed"
        message = (
            f"{joint} cannot reach its range once {other} is a little open: with {stands} it is "
            f"free until {item.free_until:.4g} {unit}, and {depth} at {pair.at:.4g} {unit}"
            f"{_near(pair)}; end its range there, or make room between the parts"
        )
    else:
        code = "joints_collide"
        message = (
            f"with {joint} at {pair.at:.4g} {unit} and {stands}, {depth}{_near(pair)}; "
            f"open one at a time, or end the range of either earlier: {joint} is free until "
            f"{item.free_until:.4g} {unit} there"
        )
    found = _finding(item.obstructed, code, message, pair, pair.excess, config.excess_m)
    return replace(found, joint=joint, joints=(joint, other))


def _left_out(neighbours: Neighbours, config: PenetrationConfig) -> Findings:
    """Yield a note on the pairs of joints that were not swept together."""
    if neighbours.unswept:
        first, second = neighbours.unswept[0]
        message = (
            f"{len(neighbours.unswept)} of {neighbours.asked} pairs of joints whose ways come near "
            f"each other were not swept together, first {first} with {second}: "
            f"{config.pair_looks} exact looks, as many as one file may take, were used up"
        )
        yield note("joints_not_swept", message, value=float(len(neighbours.unswept)))


def _combination_findings(
    study: PenetrationStudy, config: PenetrationConfig, told: Set[PartPair]
) -> Findings:
    for contact in study.combinations:
        if contact.excess <= config.excess_m or contact.parts in told:
            continue
        a, b = contact.links
        pose = ", ".join(f"{name}={value:.3g}" for name, value in contact.pose.items())
        depth = f"{mm(contact.excess):.2f} mm deeper than at rest"
        message = f"{a} and {b} penetrate {depth} when {pose}"
        code = "combination_penetration"
        yield _finding(False, code, message, contact, contact.excess, config.excess_m)


def _near(contact: Contact) -> str:
    words = " near ({:.3f}, {:.3f}, {:.3f}) m"
    return "" if contact.point is None else words.format(*contact.point)


def mm(metres: float) -> float:
    """Round to a tenth of a micrometre [mm], so that a last bit does not change a report."""
    return round(metres * 1000.0, 4) + 0.0


def _contact(contact: Contact) -> dict[str, Any]:
    """Return the fields of a :class:`MeasuredContact`."""
    point = contact.point
    return {
        "links": contact.links,
        "shapes": contact.shapes,
        "depth_mm": mm(contact.depth),
        "point_m": None if point is None else tuple(round(x, 6) + 0.0 for x in point),
        "kind": str(contact.kind),
        "visual_mm": None if contact.visual is None else mm(contact.visual),
        "cause": None if contact.cause is None else str(contact.cause),
    }


def _pair(pair: PairSweep) -> dict[str, Any]:
    """Return the fields of a :class:`MeasuredPair`."""
    depths = {"excess_mm": mm(pair.excess), "bound_mm": mm(pair.bound)}
    return {**_contact(pair), **depths, "at": round(pair.at, 6)}


def _measured_joint(sweep: JointSweep) -> MeasuredJoint:
    gaps = [-pair.excess for pair in sweep.pairs if pair.depth < 0.0]
    touching = any(pair.depth >= 0.0 for pair in sweep.pairs)
    visual = min((p.visual for p in sweep.pairs if p.visual is not None), default=None)
    alternative = sweep.alternative
    return MeasuredJoint(
        joint=sweep.joint.name,
        lower=round(sweep.lower, 6),
        upper=round(sweep.upper, 6),
        unit=sweep.joint.unit,
        excess_mm=mm(max(0.0, sweep.excess)),
        clearance_mm=0.0 if touching else mm(min(gaps)) if gaps else None,
        visual_clearance_mm=None if visual is None else mm(max(0.0, visual)),
        clear_until=sweep.clear_until and round(sweep.clear_until, 6),
        looks=sweep.looks,
        pairs=tuple(MeasuredPair(**_pair(pair)) for pair in sweep.pairs),
        needs_open=sweep.needs_open,
        waits_for=sweep.waits_for,
        with_those_open=None if alternative is None else _measured_joint(alternative),
    )


def measured(study: PenetrationStudy, rest: RestingSolids) -> MeasuredPenetration:
    """Return a study's figures as the report states them."""

    def contacts(found: Iterable[Contact]) -> tuple[MeasuredContact, ...]:
        return tuple(MeasuredContact(**_contact(each)) for each in found)

    return MeasuredPenetration(
        diagonal_m=round(rest.diagonal, 6),
        hulls=len(rest.solids.items),
        parts=rest.solids.tree.parts,
        rest=contacts(study.rest),
        zero=None if study.zero is None else contacts(study.zero),
        joints=tuple(_measured_joint(sweep) for sweep in study.sweeps),
        neighbours=tuple(
            MeasuredNeighbour(
                **_pair(item.pair),
                joint=item.joint.name,
                open=item.other.name,
                unit=item.joint.unit,
                open_at=round(item.other_at, 6),
                free_until=item.free_until and round(item.free_until, 6),
            )
            for item in study.neighbours.met
        ),
        combinations=tuple(
            MeasuredCombination(
                **_contact(item),
                excess_mm=mm(item.excess),
                values={name: round(value, 6) for name, value in item.pose.items()},
            )
            for item in study.combinations
        ),
    )
