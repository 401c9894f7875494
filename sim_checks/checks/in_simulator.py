"""One engine's verdict on one file: a killable child observes, checks compare what it saw."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

from ..config import CheckConfig
from ..description import Description
from ..geometry.apart import joints_apart
from ..processes.isolation import Failure, Outcome, WarmChild
from ..report import KILLED, OUT_OF_TIME, Finding
from ..simulators.catalog import install_line, installed, simulator
from ..simulators.observe import observe
from ..simulators.simulator import Observation
from .agreement import pose_samples
from .creep import check_creep
from .extent import undriven
from .loading import check_loading
from .motion import check_motion
from .result import CheckResult, error, note


def judge_in_simulator(
    description: Description, name: str, config: CheckConfig, child: WarmChild
) -> CheckResult:
    """Load and drive the file in one engine, in a child process that looks, and check both.

    A crash, a hang, a missing engine or a format it does not load is a finding, never an exception.

    Raises:
        ValueError: if there is no engine of this name.
    """
    engine = simulator(name)
    if not installed(name):
        message = f"{name} is not installed; {install_line(name)} adds it"
        return CheckResult((error("simulator_missing", message, simulator=name),))
    if description.format not in engine.formats:
        loads = f"{name} loads {' and '.join(engine.formats)} here, not {description.format}"
        message = f"{loads}: it did not validate this file"
        return CheckResult((note("format_not_loaded", message, simulator=name),))
    if (too_large := undriven(description, name, config.work)) is not None:
        return CheckResult((too_large,))
    asked = (name, description.path, config.motion)
    together = (pose_samples(description), joints_apart(description))
    outcome = child.call(observe, *asked, *together, limits=config.child.limits)
    if outcome.value is None:
        return CheckResult((_failure(outcome, name, description.path),))
    observation = outcome.value
    loading = check_loading(description, observation, config)
    motion = check_motion(description, observation, config)
    creep = check_creep(description, engine, observation, config)
    measurements: dict[str, Any] = {
        "loading": loading.measurements,
        "motion": {**motion.measurements, **creep.measurements},
        "blind_spots": list(engine.blind_spots),
    }
    seen = (*loading.findings, *motion.findings, *creep.findings)
    # The checks of what an engine saw know no engine: here it says who it was.
    said = (replace(f, simulator=name, message=f"{name}: {f.message}") for f in seen)
    return CheckResult(tuple(said), measurements)


def _failure(outcome: Outcome[Observation], name: str, path: Path) -> Finding:
    if outcome.failure is Failure.TIMEOUT:
        message = f"{name} gave no verdict on {path.name}: {outcome.detail}"
        return error("simulator_timeout", message, simulator=name, cause=OUT_OF_TIME)
    if isinstance(outcome.error, ValueError):
        words = " | ".join(str(outcome.error).replace(str(path.parent), "").split("\n"))
        return error("load_failed", f"{name} does not load {path.name}: {words}", simulator=name)
    message = f"{name} died on {path.name}: {outcome.detail}"
    cause = KILLED if outcome.killed else None
    return error("simulator_crashed", message, simulator=name, cause=cause)
