"""Is the file itself sound: its tree, joints, masses and shapes?"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..config import LintConfig
from ..description import Description, FloatArray, JointLine
from ..geometry.kinematics import MOVING_KINDS, NotATree, Tree, build_tree
from ..report import Finding
from .lint_inertia import inertia_findings, missing_inertia_findings
from .lint_mimic import mimic_findings
from .lint_ranges import range_findings
from .lint_resistance import resistance_findings
from .lint_shapes import shape_findings
from .result import CheckResult, Findings, about, error, graded, warning

KNOWN_KINDS = (*MOVING_KINDS, "fixed")
#: How far an axis may be from length 1.
UNIT = 1e-3
#: z is up.
DOWN: FloatArray = np.array([0.0, 0.0, -1.0])
#: Exempt pairs that a sentence names.
MOST_NAMED = 5


def check_lint(description: Description, config: LintConfig) -> CheckResult:
    """Check all that can be known without moving anything."""
    findings: list[Finding] = []
    # Without a tree nothing has a place, and nobody knows what moves.
    tree: Tree | None = None
    try:
        tree = build_tree(description)
    except NotATree as caught:
        findings.append(error("not_a_tree", f"the links form no tree: {caught}"))
    findings += _name_findings(description)
    for joint in description.joints:
        findings += _joint_findings(joint, description, config)
    findings += range_findings(description, tree, config)
    if tree is not None:
        findings += resistance_findings(description, tree, config)
    findings += mimic_findings(description)
    findings += _exempt_findings(description)
    findings += missing_inertia_findings(description, tree)
    links: list[dict[str, Any]] = []
    touchable = any(link.collisions for link in description.links)
    poses = {} if tree is None else tree.link_poses({})
    for link in description.links:
        # Where no link can be touched, that is said once for the file.
        if touchable and link.visuals and not link.collisions:
            name = repr(link.name)
            message = f"link {name} is visible but has no collision geometry: hands pass through it"
            findings.append(error("no_collision", message, parts=(link.name,)))
        findings += inertia_findings(link, config)
        down = DOWN if tree is None else poses[link.name][:3, :3].T @ DOWN
        found, numbers = shape_findings(link, down, config)
        findings += found
        links.append({"link": link.name, **numbers})
    if not touchable:
        message = "no link has collision geometry: nothing can be touched or held"
        findings.append(error("no_collision", message))
    measurements = {
        "format": description.format,
        "links": links,
        "joints": len(description.joints),
        "moving_joints": sum(joint.kind in MOVING_KINDS for joint in description.joints),
        "collision_shapes": sum(len(link.collisions) for link in description.links),
    }
    return CheckResult(tuple(findings), measurements)


def _name_findings(description: Description) -> Findings:
    names = [joint.name for joint in description.joints]
    for name in sorted({name for name in names if names.count(name) > 1}):
        yield error("duplicate_name", f"{names.count(name)} joints are named {name!r}", joint=name)
    if not any(joint.kind in MOVING_KINDS for joint in description.joints):
        yield warning("no_moving_joint", "no joint moves")


def _joint_findings(joint: JointLine, description: Description, config: LintConfig) -> Findings:
    subject = about(joint)
    name = f"joint {joint.name!r}"
    if joint.kind not in KNOWN_KINDS:
        held = any(other.child == joint.parent for other in description.joints)
        message = f"{name} is of type {joint.kind!r}; want one of {', '.join(KNOWN_KINDS)}"
        yield graded(held or joint.kind != "floating", "unknown_joint_type", message, **subject)
        return
    if joint.kind == "fixed":
        return
    length = float(np.linalg.norm(joint.axis))
    if length < UNIT or not np.isfinite(length):
        message = f"{name} has axis {joint.axis.tolist()}, want one of length 1"
        yield error("zero_axis", message, **subject)
    elif abs(length - 1.0) > UNIT:
        far = abs(length - 1.0) > config.axis_slack
        message = f"{name} has an axis of length {length:.4g}, want 1; "
        message += "loaders scale motion by it or not"
        yield graded(far, "axis_not_unit", message, **subject, value=length, limit=1.0)
    if joint.kind != "continuous":
        yield from _limit_findings(joint)
    for word, number in (("damping", joint.damping), ("friction", joint.friction)):
        if not (np.isfinite(number) and number >= 0.0):
            message = f"{name} has {word} {number}, want 0 or more"
            yield error("invalid_dynamics", message, **subject)


def _limit_findings(joint: JointLine) -> Findings:
    subject = about(joint)
    name = f"joint {joint.name!r}"
    unit = joint.unit
    if joint.lower is None or joint.upper is None:
        yield error("missing_limits", f"{name} ({joint.kind}) has no limits", **subject)
        return
    if not (np.isfinite(joint.lower) and np.isfinite(joint.upper)):
        message = f"{name} has limits {joint.lower} .. {joint.upper} {unit}, want finite ones"
        yield error("limits_not_finite", message, **subject)
        return
    said = f"{name} has limits {joint.lower:g} .. {joint.upper:g} {unit}"
    if joint.lower >= joint.upper:
        message = f"{said}: want lower below upper"
        value = joint.upper - joint.lower
        yield error("limits_not_ordered", message, **subject, value=value, unit=unit, limit=0.0)
    elif joint.lower > 0.0 or joint.upper < 0.0:
        message = f"{said}: 0, where simulators start, lies outside"
        yield warning("zero_outside_limits", message, **subject, unit=unit)


def _exempt_findings(description: Description) -> Findings:
    """Yield how many pairs of a URDF are exempt, and which; MJCF tells each where it overlaps."""
    if description.format != "urdf" or not description.excluded:
        return
    pairs = sorted(" and ".join(sorted(pair)) for pair in description.excluded)
    more = f" and {len(pairs) - MOST_NAMED} more" if len(pairs) > MOST_NAMED else ""
    named = f"{', '.join(pairs[:MOST_NAMED])}{more}"
    message = f"its SRDF exempts {len(pairs)} pairs of links from collision: {named}"
    yield warning("pairs_exempt", message, value=float(len(pairs)), unit="pairs")
