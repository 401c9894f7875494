"""What the penetration check measured, as findings and as JSON data."""

from __future__ import annotations

from collections.abc import Mapping, Set
from dataclasses import dataclass
from enum import StrEnum
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
from ..report import Finding, Severity
from .cause import CLAUSES, Cause
from .result import CheckResult

PartPair = tuple[int, int]


class PairKind(StrEnum):
    """How an overlap of two hulls is judged."""

    PLAIN = "plain"
    HINGE = "hinge"
    """The knuckle of the hinge between the two parts."""
    EXCLUDED = "excluded"
    """The file excludes the two links from contact."""


@dataclass(frozen=True)
class Contact:
    """How two parts meet in one pose.

    Attributes:
        parts: their indices, of the two hulls named here.
        links, shapes: whose hulls are worst.
        depth: [m]; negative is a gap.
        point: middle of the overlap in the root's frame [m]; ``None`` where the hulls do not meet.
        kind: how the pair is judged.
        hulls: which two hulls, as indices into the description's solids.
        pose: joint values [rad] or [m] in which they meet so.
        visual: how the visible surfaces of the two parts stand there [m]: a positive gap or a
            negative depth, see :mod:`..surfaces`; ``None`` where it was not measured or a part
            shows nothing.
        cause: the likely reason, where one can be told; see :mod:`.cause`.
    """

    parts: PartPair
    links: tuple[str, str]
    shapes: tuple[str, str]
    depth: float
    point: tuple[float, ...] | None
    kind: PairKind
    hulls: PartPair
    pose: Mapping[str, float]
    visual: float | None = None
    cause: Cause | None = None


@dataclass(frozen=True)
class PairSweep:
    """The worst of one pair of parts along one joint.

    Attributes:
        parts: their indices, ascending.
        contact: there.
        excess: depth beyond rest [m]; negative is the smallest gap.
        bound: nothing anywhere along the joint is worse than this [m].
        at: joint value [rad] or [m].
    """

    parts: PartPair
    contact: Contact
    excess: float
    bound: float
    at: float


@dataclass(frozen=True)
class JointSweep:
    """One joint over its whole range.

    Attributes:
        joint, kind: name and kind.
        lower, upper: the range swept [rad] or [m].
        pairs: pairs of parts that come near each other.
        looks: exact evaluations that it took to be certain.
        needs_open: the other joints that must be open before this one opens, in the order in which
            they do.
        alternative: the same joint with those at upper; ``None`` if it needs none, or if it never
            opens.
        waits_for: of a joint that never opens, the others that would have to make way, but do not
            open themselves.
        clear_until: how far a joint that never opens goes from lower before it fails [rad] or [m].
    """

    joint: str
    kind: str
    lower: float
    upper: float
    pairs: tuple[PairSweep, ...]
    looks: int
    needs_open: tuple[str, ...] = ()
    alternative: JointSweep | None = None
    waits_for: tuple[str, ...] = ()
    clear_until: float | None = None

    @property
    def excess(self) -> float:
        """Worst excess over rest [m] that counts; negative is a gap, minus infinity far apart."""
        plain = (pair.excess for pair in self.pairs if pair.contact.kind is PairKind.PLAIN)
        return max(plain, default=float("-inf"))


@dataclass(frozen=True)
class Combination:
    """One pair's worst over the joint combinations tried: where, how, depth beyond rest [m]."""

    values: Mapping[str, float]
    contact: Contact
    excess: float


@dataclass(frozen=True)
class BothOpen:
    """The worst of one pair of parts while one joint makes its whole way, another at upper.

    Attributes:
        joint, kind: the one that moves.
        other: the one that stands open.
        pair: where and how deep.
    """

    joint: str
    kind: str
    other: str
    pair: PairSweep


@dataclass(frozen=True)
class PenetrationStudy:
    """Everything measured; see :class:`Contact` and :class:`JointSweep`."""

    diagonal: float
    parts: tuple[tuple[str, ...], ...]
    hulls: int
    rest: tuple[Contact, ...]
    zero: tuple[Contact, ...] | None
    sweeps: tuple[JointSweep, ...]
    neighbours: tuple[BothOpen, ...]
    combinations: tuple[Combination, ...]


def report(study: PenetrationStudy, config: PenetrationConfig) -> CheckResult:
    """Findings in the order rest, joints, neighbours, combinations; and every number taken.

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
    return CheckResult(tuple(findings), _measured(study).to_dict())


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
                f"{a} and {b} lie {_mm(contact.depth):.2f} mm in one another "
                f"{pose}{_near(contact)}; at most {_mm(config.rest_m):g} mm is allowed{_why(code)}"
            )
            value = _mm(contact.depth)
            limit = _mm(config.rest_m)
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
    unit = _unit(sweep.kind)
    limit = _mm(config.excess_m)
    for pair in sweep.pairs:
        a, b = pair.contact.links
        if pair.excess <= config.excess_m:
            continue
        code, severity = _judged("sweep_penetration", pair.contact)
        if severity is Severity.HARD and sweep.alternative is not None:
            code = "joint_dependency"
            severity = Severity.SOFT
        message = (
            f"moving {sweep.joint} drives {a} and {b} {_mm(pair.excess):.2f} mm deeper into one "
            f"another than at rest, worst at {pair.at:.4g} {unit}{_near(pair.contact)}; "
            f"at most {limit:g} mm is allowed{_why(code)}"
        )
        if severity is Severity.HARD and sweep.waits_for:
            message += f"; {' and '.join(sweep.waits_for)} would have to make way, but never opens"
        if code == "joint_dependency":
            message = (
                f"{sweep.joint} is blocked while the other joints are at lower: "
                f"{a} and {b} would meet {_mm(pair.excess):.2f} mm deep at {pair.at:.4g} {unit}; "
                f"with {' and '.join(sweep.needs_open)} open its way is free"
            )
        findings.append(
            _finding(code, severity, message, pair.contact, _mm(pair.excess), limit, sweep.joint)
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
        limit = _mm(config.excess_m)
        if pair.excess <= config.excess_m or pair.parts in told:
            continue
        a, b = pair.contact.links
        unit = _unit(item.kind)
        message = (
            f"with {item.other} open, moving {item.joint} drives {a} and {b} "
            f"{_mm(pair.excess):.2f} mm deeper into one another than at rest, "
            f"worst at {pair.at:.4g} {unit}{_near(pair.contact)}"
        )
        value = _mm(pair.excess)
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
        message = (
            f"{a} and {b} lie {_mm(excess):.2f} mm deeper in one another than at rest when {pose}"
        )
        limit = _mm(config.excess_m)
        findings.append(
            _finding("combination_penetration", Severity.SOFT, message, contact, _mm(excess), limit)
        )
    return findings


def _near(contact: Contact) -> str:
    return (
        "" if contact.point is None else " near ({:.3f}, {:.3f}, {:.3f}) m".format(*contact.point)
    )


def _unit(kind: str) -> str:
    return "m" if kind == "prismatic" else "rad"


def _mm(metres: float) -> float:
    """Millimetres to a tenth of a micrometre, so that a last bit does not change a report."""
    return round(metres * 1000.0, 4) + 0.0


def _contact_figures(contact: Contact) -> dict[str, Any]:
    """The fields of a :class:`MeasuredContact`."""
    return {
        "links": contact.links,
        "shapes": contact.shapes,
        "depth_mm": _mm(contact.depth),
        "point_m": None
        if contact.point is None
        else tuple(round(x, 6) + 0.0 for x in contact.point),
        "kind": str(contact.kind),
        "visual_mm": None if contact.visual is None else _mm(contact.visual),
        "cause": None if contact.cause is None else str(contact.cause),
    }


def _pair_figures(pair: PairSweep) -> dict[str, Any]:
    """The fields of a :class:`MeasuredPair`."""
    return {
        **_contact_figures(pair.contact),
        "excess_mm": _mm(pair.excess),
        "bound_mm": _mm(pair.bound),
        "at": round(pair.at, 6),
    }


def _measured_joint(sweep: JointSweep) -> MeasuredJoint:
    gaps = [-pair.excess for pair in sweep.pairs if pair.contact.depth < 0.0]
    touching = any(pair.contact.depth >= 0.0 for pair in sweep.pairs)
    visual = min(
        (pair.contact.visual for pair in sweep.pairs if pair.contact.visual is not None),
        default=None,
    )
    alternative = sweep.alternative
    return MeasuredJoint(
        joint=sweep.joint,
        lower=round(sweep.lower, 6),
        upper=round(sweep.upper, 6),
        unit=_unit(sweep.kind),
        excess_mm=_mm(max(0.0, sweep.excess)),
        clearance_mm=0.0 if touching else _mm(min(gaps)) if gaps else None,
        visual_clearance_mm=None if visual is None else _mm(max(0.0, visual)),
        clear_until=None if sweep.clear_until is None else round(sweep.clear_until, 6),
        looks=sweep.looks,
        pairs=tuple(MeasuredPair(**_pair_figures(pair)) for pair in sweep.pairs),
        needs_open=sweep.needs_open,
        waits_for=sweep.waits_for,
        with_those_open=None if alternative is None else _measured_joint(alternative),
    )


def _measured(study: PenetrationStudy) -> MeasuredPenetration:
    zero = study.zero
    return MeasuredPenetration(
        diagonal_m=round(study.diagonal, 6),
        hulls=study.hulls,
        parts=study.parts,
        rest=tuple(MeasuredContact(**_contact_figures(contact)) for contact in study.rest),
        zero=None
        if zero is None
        else tuple(MeasuredContact(**_contact_figures(contact)) for contact in zero),
        joints=tuple(_measured_joint(sweep) for sweep in study.sweeps),
        neighbours=tuple(
            MeasuredNeighbour(
                **_pair_figures(item.pair),
                joint=item.joint,
                open=item.other,
                unit=_unit(item.kind),
            )
            for item in study.neighbours
        ),
        combinations=tuple(
            MeasuredCombination(
                **_contact_figures(item.contact),
                excess_mm=_mm(item.excess),
                values={name: round(value, 6) for name, value in item.values.items()},
            )
            for item in study.combinations
        ),
    )
