"""Findings as somebody reads them: by code, the gravest first, each told once of an asset."""

from __future__ import annotations

import math
from collections.abc import Collection, Hashable, Sequence
from dataclasses import replace

from .measurements import penetrations
from .report import Disagreement, Finding, Report, Severity

#: Digits that figures of one asset share, whichever of its files they were taken from.
DIGITS = 3


def group_findings(findings: Sequence[Finding]) -> tuple[tuple[Finding, ...], ...]:
    """Return findings by severity and code, errors first, the worst figure of each group first."""
    groups: dict[tuple[Severity, str], list[Finding]] = {}
    for finding in findings:
        groups.setdefault((finding.severity, finding.code), []).append(finding)
    keys = sorted(groups, key=lambda key: list(Severity).index(key[0]))
    return tuple(tuple(sorted(groups[key], key=_excess, reverse=True)) for key in keys)


def group_disagreements(
    disagreements: Sequence[Disagreement],
) -> tuple[tuple[Disagreement, ...], ...]:
    """Return disagreements by question and answers: those of each group differ in their joint."""
    groups: dict[Hashable, list[Disagreement]] = {}
    for each in disagreements:
        groups.setdefault((each.question, frozenset(each.verdicts.items())), []).append(each)
    return tuple(map(tuple, groups.values()))


def _excess(finding: Finding) -> float:
    """Return how far a figure is beyond its limit, as the logarithm of their ratio."""
    value = abs(finding.value or 0.0)
    limit = abs(finding.limit or 0.0)
    if value > 0.0 and limit > 0.0:
        return abs(math.log(value / limit))
    return math.inf if limit > 0.0 and finding.value is not None else value


def told_once(finding: Finding) -> Hashable:
    """Return what the same finding shares in every file that describes one asset.

    Shapes have other names in an MJCF, and a pair may come the other way round.
    """
    places = finding.parts or finding.named_joints
    value = None if finding.value is None else f"{finding.value:.{DIGITS}g}"
    said = finding.message if not places and value is None else ""
    return finding.code, finding.severity, finding.simulator, frozenset(places), value, said


def described(report: Report) -> Hashable:
    """Return the joints, their ranges and the links with shapes; ``None`` where that is unknown.

    Files of one asset share it: measurements of one of them hold for the others.
    """
    measured = penetrations({"": report.measurements})
    if not measured:
        return None
    swept = measured[0].joints
    joints = sorted(
        (j.joint, j.unit, f"{j.lower:.{DIGITS}g}", f"{j.upper:.{DIGITS}g}") for j in swept
    )
    links = report.measurements["lint"]["links"]
    shaped = (each for each in links if each["collision_shapes"] or each["visual_shapes"])
    return tuple(joints), frozenset(link["link"] for link in shaped)


def excuse_unread(report: Report, beside: Collection[Report]) -> Report:
    """Return a report without its ``not_simulated`` where a file beside it was simulated instead.

    An engine that does not read a format by nature says nothing of the asset, if it drove another
    file in its folder (``beside``) that has the same joints, ranges and links.
    """
    asset = described(report)
    driven = [each for each in beside if each.simulators and described(each) == asset]
    if asset is None or not driven:
        return report
    message = (
        f"no engine asked loads this format; {driven[0].description}, which has the same joints, "
        f"ranges and links, was driven in {', '.join(driven[0].simulators)}"
    )
    note = Finding("simulated_beside", Severity.NOTE, message)
    findings = (note if each.code == "not_simulated" else each for each in report.findings)
    return replace(report, findings=tuple(findings))
