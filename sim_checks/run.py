"""Judge one file: read, lint, penetration, then each simulator in a child of its own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .checks.result import CheckResult
from .config import CheckConfig
from .description import Description, DescriptionError
from .isolation import Limits, Outcome, run_isolated
from .report import Finding, Report, Severity

DEFAULT_CONFIG = CheckConfig()


@dataclass(frozen=True)
class _Static:
    """What needs no simulator: the file as read, and the results of the checks on it by name."""

    description: Description
    results: tuple[tuple[str, CheckResult], ...]


def run_checks(
    description: Path, simulators: Sequence[str] = ("sapien",), config: CheckConfig = DEFAULT_CONFIG
) -> Report:
    """Judge a URDF or MJCF file from anyone.

    Native code runs in killable children; whatever the file does to them becomes a finding.

    Args:
        description: the file; its meshes lie in the same folder or below.
        simulators: which engines to ask, by name, in this order; none for the static checks alone.
        config: every threshold.

    Returns:
        Findings in a fixed order: reading, lint, penetration, then simulator by simulator. The same file, settings
        and library versions give the same report.

    Raises:
        ValueError: for a simulator that does not exist, with those that do.
    """
    from .checks.in_simulator import judge_in_simulator
    from .simulators.catalog import simulator

    for name in simulators:
        simulator(name)
    path = Path(description)
    static, findings = _judge_statically(path, config)
    measurements: dict[str, Any] = {}
    if static is not None:
        for check, result in static.results:
            findings += result.findings
            measurements[check] = dict(result.measurements)
        for name in simulators:
            result = judge_in_simulator(static.description, name, config)
            findings += result.findings
            measurements[name] = dict(result.measurements)
    return Report(path.name, tuple(simulators), tuple(findings), measurements)


def _judge_statically(path: Path, config: CheckConfig) -> tuple[_Static | None, list[Finding]]:
    """All static checks in one child; where that dies, the lint alone in another, so that its word is not lost."""
    limits = Limits(wall_s=config.child.wall_s)
    outcome = run_isolated(examine, path, config, limits=limits)
    if outcome.value is not None:
        return outcome.value, []
    if isinstance(outcome.error, DescriptionError):
        return None, [Finding(outcome.error.code, Severity.HARD, outcome.error.message)]
    failure = _failure(outcome, path)
    second = run_isolated(examine, path, config, ("lint",), limits=limits)
    return second.value, [failure]


def examine(path: Path, config: CheckConfig, checks: Sequence[str] = ("lint", "penetration")) -> _Static:
    """Read a file and run the static checks on it, in this process.

    Raises:
        DescriptionError: if it cannot be read.
    """
    from .checks.lint import check_lint
    from .checks.penetration import check_penetration
    from .kinematics import NotATree
    from .reading.read import read_here

    description = read_here(path)
    results = [("lint", check_lint(description, config.lint))]
    if "penetration" in checks:
        try:
            results.append(("penetration", check_penetration(description, config.penetration)))
        except NotATree:
            # The lint has said so; without a tree there is no pose to measure in.
            results.append(("penetration", CheckResult()))
    return _Static(description, tuple(results))


def _failure(outcome: Outcome[Any], path: Path) -> Finding:
    code = "check_timeout" if outcome.failure == "timeout" else "check_crashed"
    return Finding(code, Severity.HARD, f"the static checks gave no verdict on {path.name}: {outcome.detail}")
