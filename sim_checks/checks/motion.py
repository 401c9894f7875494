"""Does every joint open and close under a hand's force, and stay where it is left?

Energy from nowhere is a finding, too.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from ..config import CheckConfig, MotionConfig
from ..description import Description, JointLine
from ..report import Finding
from ..simulators.simulator import Fall, FallMotion, JointMotion, Observation, RestMotion
from .result import (
    DECIMALS,
    CheckResult,
    Concerned,
    Findings,
    Measured,
    about,
    graded,
    measured,
    not_finite,
    note,
    rounded,
    warning,
)


def check_motion(
    description: Description, observation: Observation, config: CheckConfig
) -> CheckResult:
    """Check the drive of every joint, the rest at lower without weight, and the fall with it."""
    checks = _MotionChecks({line.name: line for line in description.joints}, config.motion)
    findings = [finding for rest in observation.rest for finding in checks.rest(rest)]
    pushed = {rest.joint for rest in observation.rest if rest.share > config.motion.drift_soft}
    # With weight, the same contacts make up the same energy again.
    known = any(finding.code == "energy_grows" for finding in findings)
    findings += checks.fall(observation.fall, known=known)
    for fallen in observation.fall.joints:
        if fallen.joint not in pushed:
            findings += checks.opened(fallen)
    for motion in observation.motions:
        findings += checks.driven(motion)
    if observation.warnings:
        message = f"complained while moving: {', '.join(observation.warnings)}"
        findings.append(warning("engine_warning", message))
    spoken_for = {motion.joint for motion in observation.motions}
    joints = observation.model.joints
    coupled = {name for each in joints if each.follows for name in (each.name, each.follows)}
    idle = [joint.name for joint in joints if joint.name not in spoken_for | coupled]
    for name in idle:
        message = f"joint {name!r} was not driven: it has no range from lower to upper"
        findings.append(note("not_driven", message, **checks.subject(name)))
    pairs = observation.model.pairs
    measurements: dict[str, Any] = {
        "joints": [_rounded(asdict(motion)) for motion in observation.motions],
        "rest": [_rounded(asdict(rest)) for rest in observation.rest],
        "fall": _rounded(asdict(observation.fall)),
        "not_driven": idle,
        "moved_with_others": sorted(coupled - spoken_for),
        "dependencies": [motion.joint for motion in observation.motions if motion.needs_open],
        "engine_warnings": list(observation.warnings),
        "pairs_enforced": None if pairs is None else pairs.words(),
    }
    return CheckResult(tuple(findings), measurements)


@dataclass(frozen=True)
class _MotionChecks:
    """The checks of one engine's motions.

    Attributes:
        lines: the file's joints, by name; an engine may have added others.
        config: thresholds.
    """

    lines: Mapping[str, JointLine]
    config: MotionConfig

    def subject(self, joint: str) -> Concerned:
        """Return a joint as the subject of a finding."""
        return about(self.lines[joint]) if joint in self.lines else {"joint": joint}

    def _unit(self, joint: str) -> str:
        return self.lines[joint].unit if joint in self.lines else ""

    def driven(self, motion: JointMotion) -> Findings:
        """Check a joint that was driven to upper and back, and let go of there."""
        config = self.config
        unit = self._unit(motion.joint)
        subject = self.subject(motion.joint)
        parts = (*subject.get("parts", ()), *(motion.blocked_by or ()))
        subject["parts"] = tuple(dict.fromkeys(parts))

        def found(grave: bool, code: str, message: str, value: float, limit: float) -> Finding:
            sentence = f"joint {motion.joint!r} {message}"
            told = _of_range(value, limit)
            return graded(grave, code, sentence, **subject, **told, joints=_leant_on(motion))

        if not motion.finite:
            yield not_finite(f"joint {motion.joint!r}", "driven", **subject)
            return
        if motion.reached < config.reach_fraction:
            message = (
                f"reached {motion.reached:.1%} of its range{_stuck(motion, unit)}, "
                f"{config.reach_fraction:.0%} is wanted{_blocker(motion)}"
            )
            yield found(True, "jammed", message, motion.reached, config.reach_fraction)
        elif motion.returned > config.return_fraction:
            message = (
                f"stayed {motion.returned:.1%} open{_stuck(motion, unit)} after driving back, "
                f"at most {config.return_fraction:.0%} may remain{_blocker(motion)}"
            )
            yield found(True, "not_returned", message, motion.returned, config.return_fraction)
        beyond = motion.overshoot / motion.range if motion.range > 0.0 else 0.0
        if beyond > config.overshoot_soft:
            grave = beyond > config.overshoot_hard
            passed = f"{motion.overshoot:.4g} {unit} ({beyond:.1%} of its range)"
            message = f"passed its limit by {passed}"
            yield found(grave, "limit_overshoot", message, beyond, config.overshoot_soft)
        if motion.others_moved > config.others_soft:
            grave = motion.others_moved > config.others_hard
            share = f"{motion.others_moved:.1%} of that joint's range"
            message = f"pushed joint {motion.pushed!r} by {share}"
            yield found(grave, "others_moved", message, motion.others_moved, config.others_soft)
        where = f"joint {motion.joint!r} was let go of"
        yield from self._energy(motion.energy, motion.energy_height, where, subject)

    def rest(self, rest: RestMotion) -> Findings:
        """Check a joint that was left alone at lower without gravity and springs."""
        subject = self.subject(rest.joint)
        if not rest.finite:
            yield not_finite(f"joint {rest.joint!r}", "left alone at its lower limit", **subject)
            return
        if rest.share > self.config.drift_soft:
            grave = rest.share > self.config.drift_hard
            who = " and ".join(map(repr, rest.pushed_by)) if rest.pushed_by else "parts"
            message = (
                f"joint {rest.joint!r} moved {rest.share:.1%} of its range by "
                f"itself, without gravity and springs: {who} overlap and push each other"
            )
            told = _of_range(rest.share, self.config.drift_soft)
            yield graded(grave, "pushed_at_rest", message, **subject, **told)
        where = f"joint {rest.joint!r} was left alone at its lower limit"
        yield from self._energy(rest.energy, rest.energy_height, where, subject)

    def fall(self, fall: Fall, *, known: bool) -> Findings:
        """Check the object left alone under its own weight; ``known`` energy is not told again."""
        if not fall.finite:
            yield not_finite("the object", "left alone under its own weight")
        elif not known:
            where = "the object was left alone under its own weight"
            yield from self._energy(fall.energy, fall.energy_height, where, {})

    def opened(self, fallen: FallMotion) -> Findings:
        """Check how far a joint opened by its own weight."""
        if fallen.share > self.config.fall_soft:
            message = (
                f"joint {fallen.joint!r} opens by its own weight, by "
                f"{fallen.moved:.4g} {self._unit(fallen.joint)} or {fallen.share:.1%} of its range "
                f"in {self.config.rest_s:g} s: nothing holds it closed"
            )
            told = _of_range(fallen.share, self.config.fall_soft)
            yield warning("opens_by_itself", message, **self.subject(fallen.joint), **told)

    def _energy(self, energy: float, height: float, where: str, subject: Concerned) -> Findings:
        """Check energy from nowhere [J], and how high it would lift the moving parts [m]."""
        config = self.config
        if not (energy > config.energy_floor_j and height > config.energy_soft_m):
            return
        allowed = max(config.energy_floor_j, config.energy_soft_m * energy / height)
        message = (
            f"{energy:.4g} J came from nowhere while {where}, "
            f"enough to lift the moving parts by {height:.3g} m; at most {allowed:.4g} J "
            f"({config.energy_soft_m:g} m) may: contacts push parts apart like springs"
        )
        grave = height > config.energy_hard_m
        yield graded(grave, "energy_grows", message, **subject, **rounded(energy, "J", allowed))


def _of_range(share: float, limit: float) -> Measured:
    return measured(round(share, DECIMALS), "of range", limit)


def _stuck(motion: JointMotion, unit: str) -> str:
    at = motion.stuck_at
    return "" if at is None else f" (at {round(at, DECIMALS) + 0.0:.4g} {unit}".rstrip() + ")"


def _blocker(motion: JointMotion) -> str:
    words = "; nothing presses on the parts that it moves"
    if motion.blocked_by is not None:
        one, two = motion.blocked_by
        words = f"; {one!r} presses on {two!r}"
    return words + "".join(f"; it pushes joint {name!r}" for name in _leant_on(motion))


def _leant_on(motion: JointMotion) -> tuple[str, ...]:
    return (motion.pushed,) if motion.pushed and motion.others_moved > 1e-4 else ()


def _rounded(value: Any) -> Any:
    """Return JSON data; ``None`` for NaN and infinity, which broken files lead to."""
    if isinstance(value, float):
        return round(value, DECIMALS) if math.isfinite(value) else None
    if isinstance(value, dict):
        return {key: _rounded(item) for key, item in value.items()}
    return [_rounded(item) for item in value] if isinstance(value, (list, tuple)) else value
