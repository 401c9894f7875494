"""What a worker made of one input, ready to be registered by somebody else."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from asset_factory.sim_checks import Finding, Report, Severity, Status
from asset_factory.sim_checks.report import KILLED

from ..asset import Asset
from ..errors import InputRejected
from ..export.bundle import Bundle
from ..intake.intake import Intake
from ..intake.naming import safe_name, well_formed
from ..intake.reads import Reads
from ..intake.source import Source
from ..manufacture.plan import Plan
from ..runtime.stages import Stages
from ..verify.validate import Verdict
from .entry import Entry
from .keys import failure_key, source_key
from .result import Result


@dataclass(frozen=True)
class Made:
    """One round's product and what was thought of it."""

    asset: Asset
    bundle: Bundle
    verdict: Verdict
    plan: Plan


@dataclass(frozen=True)
class Product:
    """The end of one build: its result, a report, and a bundle if it passed.

    Attributes:
        source: the input, as given.
        result: its row, and how long it took.
        report: its report; JSON data.
        bundle: the finished bundle's folder, in the staging folder that was given; ``None`` if it
            did not pass.
        unloaded_ids: under which an earlier attempt may be listed that did not come so far as to
            load it.
        reads: every file that it was made of: path relative to the input's folder -> SHA-256, empty
            if not there.
        done: stages that were not answered from the cache.
    """

    source: Path
    result: Result
    report: Mapping[str, Any]
    bundle: Path | None = None
    unloaded_ids: tuple[str, ...] = ()
    reads: Reads = field(default_factory=dict)
    done: tuple[str, ...] = ()

    @property
    def entry(self) -> Entry:
        """Its row."""
        return self.result.entry


def finished(origin: Source, intake: Intake, made: Made, stages: Stages) -> Product:
    """The product of an input that became an asset, good or bad."""
    asset = made.asset
    verdict = made.verdict
    entry = Entry(
        id=origin.id,
        name=intake.name,
        category=intake.provenance.category or "",
        status=verdict.status,
        reason=verdict.reason.code if verdict.reason else "",
        parts=len(asset.articulation.parts),
        joints=len(asset.articulation.movable_joints),
        hulls=asset.hull_count,
        key=_key(origin, verdict.status, verdict.reason),
        message=verdict.reason.message if verdict.reason else "",
        license=intake.provenance.license or "",
    )
    report = {**verdict.report.to_dict(), "id": entry.id, "repairs": list(made.plan.steps)}
    bundle = made.bundle.folder if verdict.status is Status.PASSED else None
    return _product(origin, entry, report, bundle, stages)


def refused(origin: Source, rejection: InputRejected, stages: Stages) -> Product:
    """The product of an input that could not become an asset at all."""
    finding = Finding(
        code=rejection.code,
        severity=Severity.HARD,
        message=rejection.message,
        value=rejection.value,
        unit=rejection.unit,
        limit=rejection.limit,
    )
    entry, report = without_asset(origin, finding, Status.REJECTED)
    return _product(origin, entry, report, None, stages)


def without_asset(origin: Source, finding: Finding, status: Status) -> tuple[Entry, dict[str, Any]]:
    """The row and the report of an input of which there is nothing else to say."""
    finding = replace(finding, message=well_formed(finding.message))
    entry = Entry(
        id=origin.id,
        name=safe_name(origin.path),
        category="",
        status=status,
        reason=finding.code,
        parts=0,
        joints=0,
        hulls=0,
        key=_key(origin, status, finding),
        message=finding.message,
    )
    report = Report(well_formed(origin.path.name), findings=(finding,))
    return entry, {**report.to_dict(), "id": entry.id, "repairs": []}


def _key(origin: Source, status: Status, reason: Finding | None) -> str:
    """Key of a result not to be redone: a verdict or too tight limits, but not a kill."""
    built = source_key(origin)
    if status is not Status.UNJUDGED:
        return built
    return (
        "" if reason is not None and reason.cause == KILLED else failure_key(built, origin.config)
    )


def _product(
    origin: Source, entry: Entry, report: dict[str, Any], bundle: Path | None, stages: Stages
) -> Product:
    clock = stages.clock
    return Product(
        source=origin.path,
        result=Result(
            input=str(origin.path),
            entry=entry,
            seconds=clock.seconds,
            stages=dict(clock.stages),
            reused=tuple(stages.reused),
        ),
        report=report,
        bundle=bundle,
        unloaded_ids=origin.unloaded_ids,
        reads=origin.reads,
        done=tuple(stages.done),
    )
