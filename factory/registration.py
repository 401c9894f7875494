"""From a verdict to a registry entry, a report and a result."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from asset_factory.sim_checks import Finding, Report, Severity
from asset_factory.sim_checks.isolation import Outcome

from .asset import Asset
from .clock import Stopwatch
from .errors import InputRejected
from .export.bundle import Bundle
from .mesh.intake import Intake
from .mesh.naming import safe_name
from .registry import Entry, Registry
from .repair import Plan
from .result import Result
from .store import digest_bytes, digest_file
from .validate import Verdict

ID_DIGITS = 10


@dataclass(frozen=True)
class Made:
    """One round's product and what was thought of it."""

    asset: Asset
    bundle: Bundle
    verdict: Verdict
    plan: Plan


def asset_id(name: str, digest: str) -> str:
    """``name`` and the first digits of the input's digest: the same input has the same id anywhere."""
    return f"{name}-{digest[:ID_DIGITS]}"


def register(registry: Registry, source: Path, intake: Intake, made: Made, clock: Stopwatch) -> Result:
    """Publish what passed, keep the report of what did not, and say which."""
    asset, verdict = made.asset, made.verdict
    entry = Entry(
        id=asset_id(intake.name, intake.provenance.digest),
        name=intake.name,
        category=intake.provenance.category or "",
        status=verdict.status,
        reason=verdict.reason.code if verdict.reason else "",
        parts=len(asset.articulation.parts),
        joints=len(asset.articulation.movable_joints),
        hulls=asset.hull_count,
    )
    report = {**verdict.report.to_dict(), "id": entry.id, "repairs": list(made.plan.steps)}
    with clock.stage("register"):
        # An earlier attempt may have ended before the input's own digest was known.
        registry.forget(unloaded_id(source), except_id=entry.id)
        if verdict.status == "passed":
            registry.publish(entry, made.bundle.folder, report)
        else:
            registry.reject(entry, report)
    return _result(source, entry, verdict.report, clock)


def register_rejection(registry: Registry, source: Path, rejection: InputRejected, clock: Stopwatch) -> Result:
    """Keep the report of an input that could not become an asset at all."""
    finding = Finding(
        code=rejection.code,
        severity=Severity.HARD,
        message=rejection.message,
        value=rejection.value,
        unit=rejection.unit,
        limit=rejection.limit,
    )
    return _without_asset(registry, source, finding, "rejected", clock)


def register_failure(registry: Registry, source: Path, outcome: Outcome[Result], clock: Stopwatch) -> Result:
    """Keep the report of an input whose process crashed, hung or met a bug of ours."""
    code = "build_timeout" if outcome.failure == "timeout" else "build_crashed"
    finding = Finding(code=code, severity=Severity.HARD, message=f"building {source.name}: {outcome.detail}")
    return _without_asset(registry, source, finding, "unjudged", clock)


def unloaded_id(source: Path) -> str:
    """Id of an input that has not been loaded: from its name and its own bytes only."""
    try:
        digest = digest_file(source)
    except OSError:
        digest = digest_bytes(str(source).encode())
    return asset_id(safe_name(source), digest)


def _without_asset(registry: Registry, source: Path, finding: Finding, status: str, clock: Stopwatch) -> Result:
    entry = Entry(unloaded_id(source), safe_name(source), "", status, finding.code, 0, 0, 0)
    report = Report(source.name, findings=(finding,))
    registry.reject(entry, {**report.to_dict(), "id": entry.id, "repairs": []})
    return _result(source, entry, report, clock)


def _result(source: Path, entry: Entry, report: Report, clock: Stopwatch) -> Result:
    return Result(
        id=entry.id,
        input=str(source),
        status=entry.status,
        reason=entry.reason,
        message=report.hard[0].message if report.hard else "",
        parts=entry.parts,
        joints=entry.joints,
        hulls=entry.hulls,
        seconds=clock.seconds,
        stages=dict(clock.stages),
    )
