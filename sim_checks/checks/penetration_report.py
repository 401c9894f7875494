"""What the penetration check measured, as findings and as JSON data."""

from __future__ import annotations

from collections.abc import Iterator, Sequence, Set
from dataclasses import replace

from ..config import PenetrationConfig
from ..report import Finding
from .cause import CLAUSES
from .penetration_figures import measured, mm
from .penetration_study import (
    BothOpen,
    Contact,
    JointSweep,
    Neighbours,
    PairKind,
    PartPair,
    PenetrationStudy,
)
from .result import CheckResult, graded, note

#: Of pairs that may overlap: how that is told, and why it may.
EXEMPT = {
    PairKind.HINGE: ("hinge_overlap", ", but this is the knuckle of their hinge"),
    PairKind.EXCLUDED: (
        "excluded_penetration",
        ", but the file excludes this pair from contact",
    ),
}


def report(study: PenetrationStudy, config: PenetrationConfig) -> CheckResult:
    """Return findings in the order rest, joints, neighbours, combinations; and every number.

    The measurements are plain JSON data. Wherever two parts were found to meet, ``visual_mm`` says
    how their visible surfaces stand there (a positive gap, at most the clearance that is measured,
    or a negative depth; null where it was not measured) and ``cause`` why, where that can be told.
    ``visual_clearance_mm`` of a joint is the same where its hulls come nearest. ``needs_open`` of a
    joint names those that must be open before it, in the order in which they open, and
    ``waits_for`` those that would have to be and never are. ``neighbours`` holds what joints do
    while another stands open, at ``open_at``.
    """
    findings = [*_rest_findings(study, config)]
    for sweep in study.sweeps:
        findings.extend(_sweep_findings(sweep, config))
    colliding = [item for item in study.neighbours.met if item.pair.excess > config.excess_m]
    findings.extend(_both_open(item, config) for item in colliding)
    findings.extend(_left_out(study.neighbours, config))
    told = told_parts(study.sweeps, config) | {item.pair.parts for item in colliding}
    findings.extend(_combination_findings(study, config, told))
    return CheckResult(tuple(findings), measured(study).to_dict())


def told_parts(sweeps: Sequence[JointSweep], config: PenetrationConfig) -> frozenset[PartPair]:
    """Return the pairs of parts that meet too deeply while all joints but one are closed."""
    return frozenset(
        pair.parts for sweep in sweeps for pair in sweep.pairs if pair.excess > config.excess_m
    )


def _rest_findings(study: PenetrationStudy, config: PenetrationConfig) -> Iterator[Finding]:
    at_rest = {contact.parts: contact.depth for contact in study.rest}
    poses = [
        ("with every joint at its lower limit", study.rest),
        ("with every joint at 0", study.zero or ()),
    ]
    for pose, contacts in poses:
        for contact in contacts:
            repeated = (
                contacts is study.zero
                and contact.depth <= at_rest.get(contact.parts, 0.0) + config.excess_m
            )
            if contact.depth <= config.rest_m or repeated:
                continue
            code, why = EXEMPT.get(contact.kind, ("rest_penetration", ""))
            a, b = contact.links
            message = (
                f"{a} and {b} overlap by {mm(contact.depth):.2f} mm "
                f"{pose}{_near(contact)}; at most {mm(config.rest_m):g} mm is allowed{why}"
            )
            grave = contact.kind is PairKind.PLAIN
            yield _finding(grave, code, message, contact, contact.depth, config.rest_m)


def _sweep_findings(sweep: JointSweep, config: PenetrationConfig) -> Iterator[Finding]:
    joint = sweep.joint.name
    unit = sweep.joint.unit
    for pair in sweep.pairs:
        if pair.excess <= config.excess_m:
            continue
        a, b = pair.contact.links
        depth = mm(pair.excess)
        grave = pair.contact.kind is PairKind.PLAIN
        code, why = EXEMPT.get(pair.contact.kind, ("sweep_penetration", ""))
        message = (
            f"as {joint} moves, {a} and {b} penetrate {depth:.2f} mm deeper than "
            f"at rest, worst at {pair.at:.4g} {unit}{_near(pair.contact)}; "
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
        found = _finding(grave, code, message, pair.contact, pair.excess, config.excess_m)
        yield replace(found, joint=joint)


def _finding(
    grave: bool, code: str, message: str, contact: Contact, depth: float, most: float
) -> Finding:
    """Return what there is to say of a contact that is deeper than the most allowed [m]."""
    clause = "" if contact.cause is None else f"; {CLAUSES[contact.cause]}"
    cause = None if contact.cause is None else str(contact.cause)
    parts = contact.links
    value = mm(depth)
    limit = mm(most)
    return graded(
        grave, code, message + clause, parts=parts, value=value, unit="mm", limit=limit, cause=cause
    )


def _both_open(item: BothOpen, config: PenetrationConfig) -> Finding:
    """Return what two joints do that run parts into each other when both are open."""
    pair = item.pair
    joint = item.joint.name
    other = item.other.name
    unit = item.joint.unit
    stands = f"{other} at {item.other_at:.4g} {item.other.unit}"
    a, b = pair.contact.links
    depth = f"{a} and {b} penetrate {mm(pair.excess):.2f} mm deeper than at rest"
    if item.obstructed:
        code = "joint_obstructed"
        message = (
            f"{joint} cannot reach its range once {other} is a little open: with {stands} it is "
            f"free until {item.free_until:.4g} {unit}, and {depth} at {pair.at:.4g} {unit}"
            f"{_near(pair.contact)}; end its range there, or make room between the parts"
        )
    else:
        code = "joints_collide"
        message = (
            f"with {joint} at {pair.at:.4g} {unit} and {stands}, {depth}{_near(pair.contact)}; "
            f"open one at a time, or end the range of either earlier: {joint} is free until "
            f"{item.free_until:.4g} {unit} there"
        )
    found = _finding(item.obstructed, code, message, pair.contact, pair.excess, config.excess_m)
    return replace(found, joint=joint, joints=(joint, other))


def _left_out(neighbours: Neighbours, config: PenetrationConfig) -> Iterator[Finding]:
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
) -> Iterator[Finding]:
    for combination in study.combinations:
        contact = combination.contact
        excess = combination.excess
        first, second = sorted(contact.parts)
        if excess <= config.excess_m or (first, second) in told:
            continue
        a, b = contact.links
        pose = ", ".join(f"{name}={value:.3g}" for name, value in combination.values.items())
        message = f"{a} and {b} penetrate {mm(excess):.2f} mm deeper than at rest when {pose}"
        code = "combination_penetration"
        yield _finding(False, code, message, contact, excess, config.excess_m)


def _near(contact: Contact) -> str:
    return (
        "" if contact.point is None else " near ({:.3f}, {:.3f}, {:.3f}) m".format(*contact.point)
    )
