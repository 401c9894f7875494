"""Does every joint open and close under a hand's force, and stay where it is left?

Energy from nowhere is a finding, too.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict
from typing import Any

from ..config import CheckConfig, MotionConfig
from ..description import Description
from ..report import Finding, Severity
from ..simulators.simulator import Fall, FallMotion, JointMotion, Observation, RestMotion
from .result import CheckResult, error, note, warning

#: Numbers in a report keep this many decimals: engines differ in the last bits from machine to
#: machine.
DECIMALS = 6


def check_motion(
    description: Description, simulator: str, observation: Observation, config: CheckConfig
) -> CheckResult:
    """Check the drive of every joint, the rest at lower without weight, and the fall with it.

    Args:
        description: what the file says; names the parts.
        simulator: whose word ``observation`` is.
        observation: from :func:`~asset_factory.sim_checks.simulators.observe.observe`.
        config: thresholds in ``config.motion``.
    """
    parts = {line.name: (line.parent, line.child) for line in description.joints}
    units = {line.name: "m" if line.kind == "prismatic" else "rad" for line in description.joints}
    findings: list[Finding] = []
    for rest in observation.rest:
        findings.extend(_rest_findings(rest, parts.get(rest.joint, ()), simulator, config.motion))
    pushed = {rest.joint for rest in observation.rest if rest.share > config.motion.drift_soft}
    # With weight, the same contacts make up the same energy again.
    known = any(finding.code == "energy_grows" for finding in findings)
    findings.extend(_fall_findings(observation.fall, simulator, config.motion, known=known))
    for fallen in observation.fall.joints:
        if fallen.joint not in pushed:
            own = parts.get(fallen.joint, ()), units.get(fallen.joint, "")
            findings.extend(_opened(fallen, *own, simulator, config.motion))
    for motion in observation.motions:
        own = parts.get(motion.joint, ()), units.get(motion.joint, "")
        findings.extend(_motion_findings(motion, *own, simulator, config.motion))
    if observation.warnings:
        message = f"{simulator} complained while moving: {', '.join(observation.warnings)}"
        findings.append(warning("engine_warning", message, simulator=simulator))
    spoken_for = {motion.joint for motion in observation.motions}
    coupled = {
        name
        for joint in observation.model.joints
        if joint.follows
        for name in (joint.name, joint.follows)
    }
    idle = [
        joint.name for joint in observation.model.joints if joint.name not in spoken_for | coupled
    ]
    for name in idle:
        message = f"{simulator}: joint {name!r} was not driven: it has no range from lower to upper"
        findings.append(
            note("not_driven", message, simulator=simulator, joint=name, parts=parts.get(name, ()))
        )
    measurements: dict[str, Any] = {
        "joints": [_rounded(asdict(motion)) for motion in observation.motions],
        "rest": [_rounded(asdict(rest)) for rest in observation.rest],
        "fall": _rounded(asdict(observation.fall)),
        "not_driven": idle,
        "moved_with_others": sorted(coupled - spoken_for),
        "dependencies": [motion.joint for motion in observation.motions if motion.needs_open],
        "engine_warnings": list(observation.warnings),
        "pairs_enforced": observation.model.pairs.words()
        if observation.model.pairs is not None
        else None,
    }
    return CheckResult(tuple(findings), measurements)


def _motion_findings(
    motion: JointMotion, parts: tuple[str, ...], unit: str, simulator: str, config: MotionConfig
) -> Iterator[Finding]:
    others = _leant_on(motion)
    parts += tuple(link for link in motion.blocked_by or () if link not in parts)

    def found(code: str, severity: Severity, message: str, value: float, limit: float) -> Finding:
        sentence = f"{simulator}: joint {motion.joint!r} {message}"
        return Finding(
            code,
            severity,
            sentence,
            simulator,
            motion.joint,
            parts,
            round(value, DECIMALS),
            "of range",
            limit,
            joints=others,
        )

    if not motion.finite:
        message = f"{simulator}: joint {motion.joint!r} went to infinity or NaN while driven"
        yield error("not_finite", message, simulator=simulator, joint=motion.joint, parts=parts)
        return
    if motion.reached < config.reach_fraction:
        message = (
            f"reached {motion.reached:.1%} of its range{_stuck(motion, unit)}, "
            f"{config.reach_fraction:.0%} is wanted{_blocker(motion)}"
        )
        yield found("jammed", Severity.ERROR, message, motion.reached, config.reach_fraction)
    elif motion.returned > config.return_fraction:
        message = (
            f"stayed {motion.returned:.1%} open{_stuck(motion, unit)} after driving back, "
            f"at most {config.return_fraction:.0%} may remain{_blocker(motion)}"
        )
        yield found(
            "not_returned", Severity.ERROR, message, motion.returned, config.return_fraction
        )
    beyond = motion.overshoot / motion.range if motion.range > 0.0 else 0.0
    if beyond > config.overshoot_soft:
        severity = Severity.ERROR if beyond > config.overshoot_hard else Severity.WARNING
        message = f"passed its limit by {motion.overshoot:.4g} {unit} ({beyond:.1%} of its range)"
        yield found("limit_overshoot", severity, message, beyond, config.overshoot_soft)
    if motion.others_moved > config.others_soft:
        severity = Severity.ERROR if motion.others_moved > config.others_hard else Severity.WARNING
        message = (
            f"pushed joint {motion.pushed!r} by {motion.others_moved:.1%} of that joint's range"
        )
        yield found("others_moved", severity, message, motion.others_moved, config.others_soft)
    if _made_up(motion.energy, motion.energy_height, config):
        where = f"joint {motion.joint!r} was let go of"
        yield _energy(
            motion.energy, motion.energy_height, where, simulator, config, motion.joint, parts
        )


def _rest_findings(
    rest: RestMotion, parts: tuple[str, ...], simulator: str, config: MotionConfig
) -> Iterator[Finding]:
    if not rest.finite:
        message = (
            f"{simulator}: joint {rest.joint!r} went to infinity or NaN while left "
            "alone at its lower limit"
        )
        yield error("not_finite", message, simulator=simulator, joint=rest.joint, parts=parts)
        return
    if rest.share > config.drift_soft:
        severity = Severity.ERROR if rest.share > config.drift_hard else Severity.WARNING
        who = " and ".join(map(repr, rest.pushed_by)) if rest.pushed_by else "parts"
        message = (
            f"{simulator}: joint {rest.joint!r} moved {rest.share:.1%} of its range by itself, "
            f"without gravity and springs: {who} overlap and push each other"
        )
        share = round(rest.share, DECIMALS)
        yield Finding(
            "pushed_at_rest",
            severity,
            message,
            simulator,
            rest.joint,
            parts,
            share,
            "of range",
            config.drift_soft,
        )
    if _made_up(rest.energy, rest.energy_height, config):
        where = f"joint {rest.joint!r} was left alone at its lower limit"
        yield _energy(rest.energy, rest.energy_height, where, simulator, config, rest.joint, parts)


def _fall_findings(
    fall: Fall, simulator: str, config: MotionConfig, *, known: bool
) -> Iterator[Finding]:
    if not fall.finite:
        message = (
            f"{simulator}: the object went to infinity or NaN while left alone under its own weight"
        )
        yield error("not_finite", message, simulator=simulator)
    elif not known and _made_up(fall.energy, fall.energy_height, config):
        yield _energy(
            fall.energy,
            fall.energy_height,
            "the object was left alone under its own weight",
            simulator,
            config,
        )


def _opened(
    fallen: FallMotion, parts: tuple[str, ...], unit: str, simulator: str, config: MotionConfig
) -> Iterator[Finding]:
    if fallen.share > config.fall_soft:
        message = (
            f"{simulator}: joint {fallen.joint!r} opens by its own weight, "
            f"by {fallen.moved:.4g} {unit} or {fallen.share:.1%} of its range in "
            f"{config.rest_s:g} s: nothing holds it closed"
        )
        share = round(fallen.share, DECIMALS)
        yield warning(
            "opens_by_itself",
            message,
            simulator=simulator,
            joint=fallen.joint,
            parts=parts,
            value=share,
            unit="of range",
            limit=config.fall_soft,
        )


def _made_up(energy: float, height: float, config: MotionConfig) -> bool:
    return energy > config.energy_floor_j and height > config.energy_soft_m


def _energy(
    energy: float,
    height: float,
    where: str,
    simulator: str,
    config: MotionConfig,
    joint: str | None = None,
    parts: tuple[str, ...] = (),
) -> Finding:
    severity = Severity.ERROR if height > config.energy_hard_m else Severity.WARNING
    allowed = max(config.energy_floor_j, config.energy_soft_m * energy / height)
    message = (
        f"{simulator}: {energy:.4g} J came from nowhere while {where}, "
        f"enough to lift the moving parts by {height:.3g} m; at most {allowed:.4g} J "
        f"({config.energy_soft_m:g} m) may: contacts push parts apart like springs"
    )
    number = round(energy, DECIMALS)
    limit = round(allowed, DECIMALS)
    return Finding("energy_grows", severity, message, simulator, joint, parts, number, "J", limit)


def _stuck(motion: JointMotion, unit: str) -> str:
    at = motion.stuck_at
    return "" if at is None else f" (at {round(at, DECIMALS) + 0.0:.4g} {unit}".rstrip() + ")"


def _blocker(motion: JointMotion) -> str:
    words = ""
    if motion.blocked_by is not None:
        one, two = motion.blocked_by
        words += f"; {one!r} presses on {two!r}"
    else:
        words += "; nothing presses on the parts that it moves"
    words += "".join(f"; it pushes joint {name!r}" for name in _leant_on(motion))
    return words


def _leant_on(motion: JointMotion) -> tuple[str, ...]:
    return (motion.pushed,) if motion.pushed and motion.others_moved > 1e-4 else ()


def _rounded(value: Any) -> Any:
    if isinstance(value, float):
        return round(value, DECIMALS)
    if isinstance(value, dict):
        return {key: _rounded(item) for key, item in value.items()}
    return [_rounded(item) for item in value] if isinstance(value, (list, tuple)) else value
