"""What a worker made of one input, ready to be registered by somebody else."""

from __future__ import annotations

import shutil
from dataclasses import dataclass, field, replace
from pathlib import Path

from asset_factory.sim_checks import Finding, Report, Status

from ..errors import InputRejected, Unjudged
from ..export.bundle import Bundle
from ..intake.intake import Intake
from ..intake.naming import safe_name, well_formed
from ..intake.reads import Reads
from ..intake.source import Source
from ..manufacture.repair import Repair
from ..runtime.layout import MANIFEST, MODEL
from ..runtime.stages import Stages
from ..verify.validate import Verdict
from .entry import Entry
from .keys import failure_key, source_key
from .report_file import BuildReport
from .result import Result

#: What is kept of an asset that did not pass.
SHOWN = frozenset({MANIFEST, MODEL})


@dataclass(frozen=True)
class Product:
    """The end of one build: its result, a report, and the folder that it is in.

    Attributes:
        result: its row, and how long it took.
        told: its report.
        bundle: the finished bundle's folder, in the staging folder that was given; of a rejected
            one a folder of its model for pages, and ``None`` without.
        unloaded_ids: under which an earlier attempt may be listed that did not come so far as to
            load it.
        reads: every file that it was made of: path relative to the input's folder -> SHA-256, empty
            if not there.
        done: stages that were not answered from the cache.
    """

    result: Result
    told: BuildReport
    bundle: Path | None = None
    unloaded_ids: tuple[str, ...] = ()
    reads: Reads = field(default_factory=dict)
    done: tuple[str, ...] = ()

    @property
    def entry(self) -> Entry:
        """Return its row."""
        return self.result.entry


def finished(
    origin: Source,
    intake: Intake,
    bundle: Bundle,
    verdict: Verdict,
    repairs: tuple[Repair, ...],
    stages: Stages,
) -> Product:
    """Return the product of an input that became an asset, good or bad."""
    asset = bundle.layout.asset
    entry = Entry(
        id=origin.id,
        name=intake.name,
        category=intake.provenance.category or "",
        status=verdict.report.status,
        reason=verdict.reason.code if verdict.reason else "",
        parts=len(asset.articulation.parts),
        joints=len(asset.articulation.movable_joints),
        hulls=asset.hull_count,
        key=_key(origin, verdict.report.status, verdict.reason),
        message=verdict.reason.message if verdict.reason else "",
        license=intake.provenance.license or "",
    )
    if verdict.report.status is not Status.PASSED:
        _keep_shown(bundle.folder)
    told = BuildReport(verdict.report, repairs)
    return _product(origin, entry, told, bundle.folder, stages)


def _keep_shown(bundle: Path) -> None:
    """Keep only an asset's model for pages; nobody shall take a rejected one for an asset."""
    for path in bundle.iterdir():
        if path.is_dir():
            shutil.rmtree(path)
        elif path.name not in SHOWN:
            path.unlink()


def refused(
    origin: Source, why: InputRejected | Unjudged, stages: Stages, shown: Path | None = None
) -> Product:
    """Return the product of an input that became no asset; ``shown`` is kept of it."""
    status = Status.UNJUDGED if isinstance(why, Unjudged) else Status.REJECTED
    entry, report = without_asset(origin, why.finding, status)
    return _product(origin, entry, report, shown, stages)


def without_asset(origin: Source, finding: Finding, status: Status) -> tuple[Entry, BuildReport]:
    """Return the row and the report of an input of which there is nothing else to say."""
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
    return entry, BuildReport(Report(well_formed(origin.path.name), findings=(finding,)))


def _key(origin: Source, status: Status, reason: Finding | None) -> str:
    """Return the key of a result not to be redone: a verdict or a crash, not a time-out."""
    built = source_key(origin)
    if status is not Status.UNJUDGED:
        return built
    return "" if reason is not None and reason.stopped else failure_key(built, origin.config)


def _product(
    origin: Source, entry: Entry, told: BuildReport, bundle: Path | None, stages: Stages
) -> Product:
    clock = stages.clock
    return Product(
        result=Result(
            input=str(origin.place),
            entry=entry,
            seconds=clock.seconds,
            stages=dict(clock.stages),
            reused=tuple(stages.reused),
        ),
        told=told,
        bundle=bundle,
        unloaded_ids=origin.unloaded_ids,
        reads=origin.reads,
        done=tuple(stages.done),
    )
