"""One engine's verdict on one file: a single killable child looks, two checks judge what it saw."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from ..config import CheckConfig
from ..description import Description, JointLine
from ..isolation import Limits, Outcome, run_isolated
from ..report import Finding, Severity
from ..simulators.catalog import install_line, installed, simulator
from ..simulators.observe import observe
from ..simulators.simulator import JointValues, Observation
from .loading import check_loading
from .motion import check_motion
from .result import CheckResult

#: Shares of the range at which link poses are compared; irrational steps, so that no symmetry hides a sign.
POSE_SHARES = (0.0, 1.0, 0.381966, 0.763932)


def judge_in_simulator(description: Description, name: str, config: CheckConfig) -> CheckResult:
    """Load and drive the file in one engine, in one child process, and judge both.

    A crash, a hang, a missing engine or a format it does not load is a finding, never an exception.

    Raises:
        ValueError: if there is no engine of this name.
    """
    engine = simulator(name)
    if not installed(name):
        message = f"{name} is not installed; {install_line(name)} adds it"
        return _only(Finding("simulator_missing", Severity.HARD, message, simulator=name))
    if description.format not in engine.formats:
        message = (
            f"{name} loads {' and '.join(engine.formats)} here, not {description.format}: it did not judge this file"
        )
        return _only(Finding("format_not_loaded", Severity.SOFT, message, simulator=name))
    samples = pose_samples(description)
    limits = Limits(wall_s=config.child.wall_s)
    outcome = run_isolated(observe, name, description.path, config.motion, samples, limits=limits)
    if outcome.value is None:
        return _only(_failure(outcome, name, description.path))
    observation = outcome.value
    loading = check_loading(description, name, observation, config)
    motion = check_motion(description, name, observation, config)
    measurements: dict[str, Any] = {
        "loading": dict(loading.measurements),
        "motion": dict(motion.measurements),
        "blind_spots": list(engine.blind_spots),
    }
    return CheckResult((*loading.findings, *motion.findings), measurements)


def pose_samples(description: Description) -> tuple[JointValues, ...]:
    """Joint values at which every engine must agree with our own kinematics: ends and two uneven mixtures."""
    moving = [joint for joint in description.joints if joint.kind in ("revolute", "prismatic", "continuous")]
    return tuple(
        {
            joint.name: _at(joint, (share + 0.618034 * i) % 1.0 if 0.0 < share < 1.0 else share)
            for i, joint in enumerate(moving)
        }
        for share in POSE_SHARES
    )


def _at(joint: JointLine, share: float) -> float:
    lower, upper = joint.lower, joint.upper
    if lower is None or upper is None or not (math.isfinite(lower) and math.isfinite(upper)):
        lower, upper = 0.0, 1.0
    return lower + share * (upper - lower)


def _failure(outcome: Outcome[Observation], name: str, path: Path) -> Finding:
    if outcome.failure == "timeout":
        message = f"{name} gave no verdict on {path.name}: {outcome.detail}"
        return Finding("simulator_timeout", Severity.HARD, message, simulator=name)
    if isinstance(outcome.error, ValueError):
        words = " | ".join(str(outcome.error).replace(str(path.parent), "").split("\n"))
        return Finding("load_failed", Severity.HARD, f"{name} does not load {path.name}: {words}", simulator=name)
    message = f"{name} died on {path.name}: {outcome.detail}"
    return Finding("simulator_crashed", Severity.HARD, message, simulator=name)


def _only(finding: Finding) -> CheckResult:
    return CheckResult((finding,), {})
