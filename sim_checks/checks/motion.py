"""Does every joint open and close under a hand's force, without jamming, dragging others or flying off?"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict
from typing import Any

from ..config import CheckConfig, MotionConfig
from ..description import Description
from ..report import Finding, Severity
from ..simulators.simulator import JointMotion, Observation, RestMotion
from .result import CheckResult

#: Numbers in a report keep this many decimals: engines differ in the last bits from machine to machine.
DECIMALS = 6


def check_motion(
    description: Description, simulator: str, observation: Observation, config: CheckConfig
) -> CheckResult:
    """Judge the drive of every joint and the rest at lower.

    Args:
        description: what the file says; names the parts.
        simulator: whose word ``observation`` is.
        observation: from :func:`~asset_factory.sim_checks.simulators.observe.observe`.
        config: thresholds in ``config.motion``.
    """
    parts = {line.name: (line.parent, line.child) for line in description.joints}
    findings: list[Finding] = []
    for rest in observation.rest:
        findings.extend(_rest_findings(rest, parts.get(rest.joint, ()), simulator, config.motion))
    for motion in observation.motions:
        findings.extend(_motion_findings(motion, parts.get(motion.joint, ()), simulator, config.motion))
    if observation.warnings:
        message = f"{simulator} complained while moving: {', '.join(observation.warnings)}"
        findings.append(Finding("engine_warning", Severity.SOFT, message, simulator=simulator))
    spoken_for = {motion.joint for motion in observation.motions}
    coupled = {name for joint in observation.model.joints if joint.follows for name in (joint.name, joint.follows)}
    idle = [joint.name for joint in observation.model.joints if joint.name not in spoken_for | coupled]
    for name in idle:
        message = f"{simulator}: joint {name!r} was not driven: it has no range from lower to upper"
        findings.append(Finding("not_driven", Severity.SOFT, message, simulator, name, parts.get(name, ())))
    measurements: dict[str, Any] = {
        "joints": [_rounded(asdict(motion)) for motion in observation.motions],
        "rest": [_rounded(asdict(rest)) for rest in observation.rest],
        "not_driven": idle,
        "moved_with_others": sorted(coupled - spoken_for),
        "dependencies": [motion.joint for motion in observation.motions if motion.others_at == "upper"],
        "engine_warnings": list(observation.warnings),
    }
    return CheckResult(tuple(findings), measurements)


def _motion_findings(
    motion: JointMotion, parts: tuple[str, ...], simulator: str, config: MotionConfig
) -> Iterator[Finding]:
    unit = "of range"

    def found(code: str, severity: Severity, message: str, value: float, limit: float) -> Finding:
        sentence = f"{simulator}: joint {motion.joint!r} {message}"
        return Finding(code, severity, sentence, simulator, motion.joint, parts, round(value, DECIMALS), unit, limit)

    if not motion.finite:
        message = f"{simulator}: joint {motion.joint!r} went to infinity or NaN while driven"
        yield Finding("not_finite", Severity.HARD, message, simulator, motion.joint, parts)
        return
    if motion.reached < config.reach_fraction:
        message = f"reached {motion.reached:.1%} of its range, {config.reach_fraction:.0%} is wanted{_blocker(motion)}"
        yield found("jammed", Severity.HARD, message, motion.reached, config.reach_fraction)
    elif motion.returned > config.return_fraction:
        message = (
            f"stayed {motion.returned:.1%} open after driving back, at most {config.return_fraction:.0%} may remain"
        )
        yield found("not_returned", Severity.HARD, message, motion.returned, config.return_fraction)
    beyond = motion.overshoot / motion.range if motion.range > 0.0 else 0.0
    if beyond > config.overshoot_soft:
        severity = Severity.HARD if beyond > config.overshoot_hard else Severity.SOFT
        message = f"passed its limit by {motion.overshoot:.4g} ({beyond:.1%} of its range)"
        yield found("limit_overshoot", severity, message, beyond, config.overshoot_soft)
    if motion.others_moved > config.others_soft:
        severity = Severity.HARD if motion.others_moved > config.others_hard else Severity.SOFT
        message = f"pushed joint {motion.pushed!r} by {motion.others_moved:.1%} of that joint's range"
        yield found("others_moved", severity, message, motion.others_moved, config.others_soft)


def _rest_findings(rest: RestMotion, parts: tuple[str, ...], simulator: str, config: MotionConfig) -> Iterator[Finding]:
    if not rest.finite:
        message = f"{simulator}: joint {rest.joint!r} went to infinity or NaN while left alone at its lower limit"
        yield Finding("not_finite", Severity.HARD, message, simulator, rest.joint, parts)
    elif rest.share > config.drift_soft:
        severity = Severity.HARD if rest.share > config.drift_hard else Severity.SOFT
        message = (
            f"{simulator}: joint {rest.joint!r} moved {rest.share:.1%} of its range by itself, with gravity and "
            "springs balanced: parts overlap and push each other"
        )
        share = round(rest.share, DECIMALS)
        yield Finding(
            "pushed_at_rest", severity, message, simulator, rest.joint, parts, share, "of range", config.drift_soft
        )


def _blocker(motion: JointMotion) -> str:
    return f"; it leans on joint {motion.pushed!r}" if motion.pushed and motion.others_moved > 1e-4 else ""


def _rounded(values: dict[str, Any]) -> dict[str, Any]:
    return {key: round(value, DECIMALS) if isinstance(value, float) else value for key, value in values.items()}
