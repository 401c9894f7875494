"""Is the file itself sound: its tree, joints, masses and shapes?"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from ..config import LintConfig
from ..description import Description, FloatArray, JointLine, Link
from ..geometry.kinematics import MOVING_KINDS, NotATree, build_tree
from ..report import Finding, Severity
from .lint_exempt import exempt_findings
from .lint_inertia import inertia_findings, missing_inertia_findings
from .lint_mimic import mimic_findings
from .lint_ranges import range_findings
from .lint_resistance import resistance_findings
from .lint_shapes import shape_findings
from .result import CheckResult, error, warning

KNOWN_KINDS = (*MOVING_KINDS, "fixed")
#: How far an axis may be from length 1.
UNIT = 1e-3
#: z is up.
DOWN: FloatArray = np.array([0.0, 0.0, -1.0])


def check_lint(description: Description, config: LintConfig) -> CheckResult:
    """Check all that can be known without moving anything.

    Args:
        description: as read.
        config: what a sound file looks like.
    """
    findings = [*_tree_findings(description)]
    for joint in description.joints:
        findings.extend(_joint_findings(joint, description, config))
    findings.extend(range_findings(description, config))
    findings.extend(resistance_findings(description, config))
    findings.extend(mimic_findings(description))
    findings.extend(exempt_findings(description))
    findings.extend(missing_inertia_findings(description))
    links: list[dict[str, Any]] = []
    downs = _downs(description)
    for link in description.links:
        findings.extend(_body_findings(link))
        findings.extend(inertia_findings(link, config))
        found, numbers = shape_findings(link, downs.get(link.name, DOWN), config)
        findings.extend(found)
        links.append({"link": link.name, **numbers})
    if not any(link.collisions for link in description.links):
        # Said once for the file, not once for each link.
        findings = [finding for finding in findings if finding.code != "no_collision"]
        message = "no link has collision geometry: nothing can be touched or held"
        findings.append(error("no_collision", message))
    moving = sum(joint.kind in MOVING_KINDS for joint in description.joints)
    measurements = {
        "format": description.format,
        "links": links,
        "joints": len(description.joints),
        "moving_joints": moving,
        "collision_shapes": sum(len(link.collisions) for link in description.links),
    }
    return CheckResult(tuple(findings), measurements)


def _downs(description: Description) -> dict[str, FloatArray]:
    """Return which way is down in each link's frame, with every joint at 0."""
    try:
        poses = build_tree(description).link_poses({})
    except NotATree:
        return {}
    return {name: pose[:3, :3].T @ DOWN for name, pose in poses.items()}


def _tree_findings(description: Description) -> Iterator[Finding]:
    try:
        build_tree(description)
    except NotATree as caught:
        yield error("not_a_tree", f"the links form no tree: {caught}")
    names = [joint.name for joint in description.joints]
    for name in sorted({name for name in names if names.count(name) > 1}):
        yield error("duplicate_name", f"{names.count(name)} joints are named {name!r}", joint=name)
    if not any(joint.kind in MOVING_KINDS for joint in description.joints):
        yield warning("no_moving_joint", "no joint moves")


def _joint_findings(
    joint: JointLine, description: Description, config: LintConfig
) -> Iterator[Finding]:
    parts = (joint.parent, joint.child)
    if joint.kind not in KNOWN_KINDS:
        free = joint.kind == "floating" and not any(
            other.child == joint.parent for other in description.joints
        )
        severity = Severity.WARNING if free else Severity.ERROR
        message = (
            f"joint {joint.name!r} is of type {joint.kind!r}; want one of {', '.join(KNOWN_KINDS)}"
        )
        yield Finding("unknown_joint_type", severity, message, joint=joint.name, parts=parts)
        return
    if joint.kind == "fixed":
        return
    length = float(np.linalg.norm(joint.axis))
    if length < UNIT or not np.isfinite(length):
        message = f"joint {joint.name!r} has axis {joint.axis.tolist()}, want one of length 1"
        yield error("zero_axis", message, joint=joint.name, parts=parts)
    elif abs(length - 1.0) > UNIT:
        far = abs(length - 1.0) > config.axis_slack
        message = (
            f"joint {joint.name!r} has an axis of length {length:.4g}, want 1; "
            "loaders scale motion by it or not"
        )
        yield Finding(
            "axis_not_unit",
            Severity.ERROR if far else Severity.WARNING,
            message,
            joint=joint.name,
            parts=parts,
            value=length,
            limit=1.0,
        )
    if joint.kind != "continuous":
        yield from _limit_findings(joint)
    for word, number in (("damping", joint.damping), ("friction", joint.friction)):
        if not (np.isfinite(number) and number >= 0.0):
            message = f"joint {joint.name!r} has {word} {number}, want 0 or more"
            yield error("invalid_dynamics", message, joint=joint.name, parts=parts)


def _limit_findings(joint: JointLine) -> Iterator[Finding]:
    parts = (joint.parent, joint.child)
    unit = "m" if joint.kind == "prismatic" else "rad"
    if joint.lower is None or joint.upper is None:
        message = f"joint {joint.name!r} ({joint.kind}) has no limits"
        yield error("missing_limits", message, joint=joint.name, parts=parts)
        return
    if not (np.isfinite(joint.lower) and np.isfinite(joint.upper)):
        message = (
            f"joint {joint.name!r} has limits {joint.lower} .. {joint.upper} "
            f"{unit}, want finite ones"
        )
        yield error("limits_not_finite", message, joint=joint.name, parts=parts)
        return
    if joint.lower >= joint.upper:
        message = (
            f"joint {joint.name!r} has limits {joint.lower:g} .. {joint.upper:g} {unit}: "
            "want lower below upper"
        )
        yield error(
            "limits_not_ordered",
            message,
            joint=joint.name,
            parts=parts,
            value=joint.upper - joint.lower,
            unit=unit,
            limit=0.0,
        )
        return
    if joint.lower > 0.0 or joint.upper < 0.0:
        message = (
            f"joint {joint.name!r} has limits {joint.lower:g} .. {joint.upper:g} {unit}: "
            "0, where simulators start, lies outside"
        )
        yield warning("zero_outside_limits", message, joint=joint.name, parts=parts, unit=unit)


def _body_findings(link: Link) -> Iterator[Finding]:
    if link.visuals and not link.collisions:
        message = (
            f"link {link.name!r} is visible but has no collision geometry: hands pass through it"
        )
        yield error("no_collision", message, parts=(link.name,))
