"""What the penetration check measured, as findings and as JSON data."""

from collections.abc import Set

from ..config import PenetrationConfig
from ..report import Finding, Severity
from .cause import CLAUSES
from .penetration_figures import measured, mm, unit_of
from .penetration_study import Contact, JointSweep, PairKind, PartPair, PenetrationStudy
from .result import CheckResult


def report(study: PenetrationStudy, config: PenetrationConfig) -> CheckResult:
    """Return findings in the order rest, joints, neighbours, combinations; and every number.

    The measurements are plain JSON data. Wherever two parts were found to meet, ``visual_mm`` says
    how their visible surfaces stand there (a positive gap, at most the clearance that is measured,
    or a negative depth; null where it was not measured) and ``cause`` why, where that can be told.
    ``visual_clearance_mm`` of a joint is the same where its hulls come nearest. ``needs_open`` of a
    joint names those that must be open before it, in the order in which they open, and
    ``waits_for`` those that would have to be and never are. ``neighbours`` holds what joints do
    while another stands at ``upper``.
    """
    findings = [*_rest_findings(study, config)]
    for sweep in study.sweeps:
        findings.extend(_sweep_findings(sweep, config))
    told = {
        pair.parts
        for sweep in study.sweeps
        for pair in sweep.pairs
        if pair.excess > config.excess_m
    }
    findings.extend(_neighbour_findings(study, config, told))
    told |= {item.pair.parts for item in study.neighbours if item.pair.excess > config.excess_m}
    findings.extend(_combination_findings(study, config, told))
    return CheckResult(tuple(findings), measured(study).to_dict())


def _rest_findings(study: PenetrationStudy, config: PenetrationConfig) -> list[Finding]:
    findings = []
    at_rest = {contact.parts: contact.depth for contact in study.rest}
    poses = [("with every joint at lower", study.rest), ("with every joint at 0", study.zero or ())]
    for pose, contacts in poses:
        for contact in contacts:
            repeated = (
                contacts is study.zero
                and contact.depth <= at_rest.get(contact.parts, 0.0) + config.excess_m
            )
            if contact.depth <= config.rest_m or repeated:
                continue
            code, severity = _judged("rest_penetration", contact)
            a, b = contact.links
            message = (
                f"{a} and {b} overlap by {mm(contact.depth):.2f} mm "
                f"{pose}{_near(contact)}; at most {mm(config.rest_m):g} mm is allowed{_why(code)}"
            )
            value = mm(contact.depth)
            limit = mm(config.rest_m)
            findings.append(_finding(code, severity, message, contact, value, limit))
    return findings


def _judged(code: str, contact: Contact) -> tuple[str, Severity]:
    if contact.kind is PairKind.HINGE:
        return "hinge_overlap", Severity.SOFT
    if contact.kind is PairKind.EXCLUDED:
        return "excluded_penetration", Severity.SOFT
    return code, Severity.HARD


def _why(code: str) -> str:
    if code == "hinge_overlap":
        return ", but this is the knuckle of their hinge"
    return (
        ", but the file excludes this pair from contact" if code == "excluded_penetration" else ""
    )


def _sweep_findings(sweep: JointSweep, config: PenetrationConfig) -> list[Finding]:
    findings = []
    unit = unit_of(sweep.kind)
    limit = mm(config.excess_m)
    for pair in sweep.pairs:
        a, b = pair.contact.links
        if pair.excess <= config.excess_m:
            continue
        code, severity = _judged("sweep_penetration", pair.contact)
        if severity is Severity.HARD and sweep.alternative is not None:
            code = "joint_dependency"
            severity = Severity.SOFT
        message = (
            f"as {sweep.joint} moves, {a} and {b} penetrate {mm(pair.excess):.2f} mm deeper than "
            f"at rest, worst at {pair.at:.4g} {unit}{_near(pair.contact)}; "
            f"at most {limit:g} mm is allowed{_why(code)}"
        )
        if severity is Severity.HARD and sweep.waits_for:
            message += f"; {' and '.join(sweep.waits_for)} would have to make way, but never opens"
        if code == "joint_dependency":
            message = (
                f"{sweep.joint} is blocked while the other joints are at lower: "
                f"{a} and {b} would penetrate {mm(pair.excess):.2f} mm at {pair.at:.4g} {unit}; "
                f"with {' and '.join(sweep.needs_open)} open its way is free"
            )
        findings.append(
            _finding(code, severity, message, pair.contact, mm(pair.excess), limit, sweep.joint)
        )
    return findings


def _finding(
    code: str,
    severity: Severity,
    message: str,
    contact: Contact,
    value: float,
    limit: float,
    joint: str | None = None,
) -> Finding:
    clause = "" if contact.cause is None else f"; {CLAUSES[contact.cause]}"
    return Finding(
        code,
        severity,
        message + clause,
        joint=joint,
        parts=contact.links,
        value=value,
        unit="mm",
        limit=limit,
        cause=None if contact.cause is None else str(contact.cause),
    )


def _neighbour_findings(
    study: PenetrationStudy, config: PenetrationConfig, told: Set[PartPair]
) -> list[Finding]:
    findings = []
    for item in study.neighbours:
        pair = item.pair
        limit = mm(config.excess_m)
        if pair.excess <= config.excess_m or pair.parts in told:
            continue
        a, b = pair.contact.links
        unit = unit_of(item.kind)
        message = (
            f"with {item.other} open, as {item.joint} moves, {a} and {b} penetrate "
            f"{mm(pair.excess):.2f} mm deeper than at rest, "
            f"worst at {pair.at:.4g} {unit}{_near(pair.contact)}"
        )
        value = mm(pair.excess)
        findings.append(
            _finding(
                "combination_penetration",
                Severity.SOFT,
                message,
                pair.contact,
                value,
                limit,
                item.joint,
            )
        )
    return findings


def _combination_findings(
    study: PenetrationStudy, config: PenetrationConfig, told: Set[PartPair]
) -> list[Finding]:
    findings = []
    for combination in study.combinations:
        contact = combination.contact
        excess = combination.excess
        first, second = sorted(contact.parts)
        if excess <= config.excess_m or (first, second) in told:
            continue
        a, b = contact.links
        pose = ", ".join(f"{name}={value:.3g}" for name, value in combination.values.items())
        message = f"{a} and {b} penetrate {mm(excess):.2f} mm deeper than at rest when {pose}"
        limit = mm(config.excess_m)
        findings.append(
            _finding("combination_penetration", Severity.SOFT, message, contact, mm(excess), limit)
        )
    return findings


def _near(contact: Contact) -> str:
    return (
        "" if contact.point is None else " near ({:.3f}, {:.3f}, {:.3f}) m".format(*contact.point)
    )
