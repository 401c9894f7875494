"""Is the file itself sound: its tree, joints, masses and shapes?"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from ..config import LintConfig
from ..description import Description, FloatArray, JointLine
from ..geometry.kinematics import MOVING_KINDS, NotATree, build_tree, find_tree
from ..report import Finding
from .lint_inertia import inertia_findings, missing_inertia_findings
from .lint_mimic import mimic_findings
from .lint_ranges import range_findings
from .lint_resistance import resistance_findings
from .lint_shapes import shape_findings
from .result import CheckResult, about, error, graded, warning

KNOWN_KINDS = (*MOVING_KINDS, "fixed")
#: How far an axis may be from length 1.
UNIT = 1e-3
#: z is up.
DOWN: FloatArray = np.array([0.0, 0.0, -1.0])
#: Exempt pairs that a sentence names.
MOST_NAMED = 5


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
    findings.extend(_exempt_findings(description))
    findings.extend(missing_inertia_findings(description))
    links: list[dict[str, Any]] = []
    touchable = any(link.collisions for link in description.links)
    downs = _downs(description)
    for link in description.links:
        # Where no link can be touched, that is said once for the file.
        if touchable and link.visuals and not link.collisions:
            name = repr(link.name)
            message = f"link {name} is visible but has no collision geometry: hands pass through it"
            findings.append(error("no_collision", message, parts=(link.name,)))
        findings.extend(inertia_findings(link, config))
        found, numbers = shape_findings(link, downs.get(link.name, DOWN), config)
        findings.extend(found)
        links.append({"link": link.name, **numbers})
    if not touchable:
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
    tree = find_tree(description)
    poses = {} if tree is None else tree.link_poses({})
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
    if joint.kind not in KNOWN_KINDS:
        free = joint.kind == "floating" and not any(
            other.child == joint.parent for other in description.joints
        )
        message = (
            f"joint {joint.name!r} is of type {joint.kind!r}; want one of {', '.join(KNOWN_KINDS)}"
        )
        yield graded(not free, "unknown_joint_type", message, **about(joint))
        return
    if joint.kind == "fixed":
        return
    length = float(np.linalg.norm(joint.axis))
    if length < UNIT or not np.isfinite(length):
        message = f"joint {joint.name!r} has axis {joint.axis.tolist()}, want one of length 1"
        yield error("zero_axis", message, **about(joint))
    elif abs(length - 1.0) > UNIT:
        far = abs(length - 1.0) > config.axis_slack
        message = (
            f"joint {joint.name!r} has an axis of length {length:.4g}, want 1; "
            "loaders scale motion by it or not"
        )
        yield graded(far, "axis_not_unit", message, **about(joint), value=length, limit=1.0)
    if joint.kind != "continuous":
        yield from _limit_findings(joint)
    for word, number in (("damping", joint.damping), ("friction", joint.friction)):
        if not (np.isfinite(number) and number >= 0.0):
            message = f"joint {joint.name!r} has {word} {number}, want 0 or more"
            yield error("invalid_dynamics", message, **about(joint))


def _limit_findings(joint: JointLine) -> Iterator[Finding]:
    subject = about(joint)
    unit = joint.unit
    if joint.lower is None or joint.upper is None:
        yield error(
            "missing_limits", f"joint {joint.name!r} ({joint.kind}) has no limits", **subject
        )
        return
    if not (np.isfinite(joint.lower) and np.isfinite(joint.upper)):
        ends = f"{joint.lower} .. {joint.upper} {unit}"
        message = f"joint {joint.name!r} has limits {ends}, want finite ones"
        yield error("limits_not_finite", message, **subject)
        return
    said = f"joint {joint.name!r} has limits {joint.lower:g} .. {joint.upper:g} {unit}"
    if joint.lower >= joint.upper:
        message = f"{said}: want lower below upper"
        value = joint.upper - joint.lower
        yield error("limits_not_ordered", message, **subject, value=value, unit=unit, limit=0.0)
    elif joint.lower > 0.0 or joint.upper < 0.0:
        message = f"{said}: 0, where simulators start, lies outside"
        yield warning("zero_outside_limits", message, **subject, unit=unit)


def _exempt_findings(description: Description) -> Iterator[Finding]:
    """Yield how many pairs of a URDF are exempt, and which; MJCF tells each where it overlaps."""
    if description.format != "urdf" or not description.excluded:
        return
    pairs = sorted(" and ".join(sorted(pair)) for pair in description.excluded)
    more = f" and {len(pairs) - MOST_NAMED} more" if len(pairs) > MOST_NAMED else ""
    message = (
        f"its SRDF exempts {len(pairs)} pairs of links from collision: "
        f"{', '.join(pairs[:MOST_NAMED])}{more}"
    )
    yield warning("pairs_exempt", message, value=float(len(pairs)), unit="pairs")
