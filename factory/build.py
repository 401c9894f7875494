"""The pipeline, in order: one input in, one registry entry out."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from asset_factory.sim_checks.judge import Judge

from .articulate.stage import readings
from .articulation import Articulation
from .config import BuildConfig
from .errors import InputRejected
from .export.bundle import export_bundle
from .export.model import write_input, write_model
from .intake.intake import Intake
from .intake.source import Source
from .manufacture.plan import Plan, dispensable_joints, first_plan
from .manufacture.stage import manufacture
from .registry import Registry
from .registry.product import Made, Product, finished, refused
from .registry.registration import register
from .registry.result import Result
from .runtime.layout import CACHE
from .runtime.stages import Stages
from .runtime.store import Store
from .verify.drafts import ReadingDraft, best_of
from .verify.kept import with_kept
from .verify.repair import next_plan
from .verify.validate import inspect, validate


def make_asset(
    source: Path,
    staging: Path,
    config: BuildConfig,
    cache: Path | None,
    judge: Judge,
    place: Path | None = None,
) -> Product:
    """Make, judge and repair one input; register nothing.

    Args:
        source: a mesh, URDF or MJCF file.
        staging: an empty folder to work in.
        config: every stage's settings.
        cache: where results of expensive stages are kept; ``None``: nowhere.
        judge: with the configuration's thresholds.
        place: where the input lies for whoever registers it, if that is elsewhere.

    Returns:
        What is to be registered. A bad input is a rejected product, never an exception.
    """
    stages = Stages(config, Store(cache) if cache else None)
    origin = Source(source, config, place)
    intake: Intake | None = None
    try:
        with stages.clock.stage("load"):
            intake = origin.load()
        likeliest_first = readings(intake, origin.loaded_key, stages)
        drafts = _drafts(likeliest_first, intake, staging, judge, stages)
        draft, others = best_of(drafts)
        told = (*draft.findings, *others)
        verdict = validate(draft.bundle, config.simulators, judge, told, draft.inspected, stages)
        verdict = with_kept(verdict, draft.reading, draft.asset.articulation)
        with stages.clock.stage("model"):
            write_model(draft.asset, draft.bundle.folder, draft.before)
        made = Made(draft.asset, draft.bundle, verdict, draft.plan)
        return finished(origin, intake, made, stages)
    except InputRejected as rejection:
        shown = None if intake is None else write_input(intake.mesh, staging / "input")
        return refused(origin, rejection, stages, shown)


def _drafts(
    likeliest_first: tuple[Articulation, ...],
    intake: Intake,
    staging: Path,
    judge: Judge,
    stages: Stages,
) -> Iterator[ReadingDraft]:
    """Each reading as an asset, repaired and judged without simulators, while there is time."""
    limits = stages.config.readings
    refused_first: InputRejected | None = None
    made = 0
    for number, articulation in enumerate(likeliest_first[: limits.most]):
        if number and stages.clock.busy > limits.within_s:
            break
        try:
            draft = _draft(articulation, intake, staging / str(number), judge, stages)
        except InputRejected as rejection:
            refused_first = refused_first or rejection
            continue
        made += 1
        yield draft
    if refused_first is not None and not made:
        raise refused_first


def _draft(
    articulation: Articulation, intake: Intake, staging: Path, judge: Judge, stages: Stages
) -> ReadingDraft:
    """Make, judge and repair, until nothing is left to repair."""
    config = stages.config.repair
    spare = dispensable_joints(articulation, config.small_share)

    def made(plan: Plan, folder: str) -> ReadingDraft:
        asset, findings = manufacture(articulation, plan, intake, stages)
        with stages.clock.stage("export"):
            bundle = export_bundle(
                asset,
                intake.provenance,
                staging / folder,
                tuple(sorted(plan.exclude)),
                stages.config.formats,
            )
        inspected = inspect(bundle, judge, findings, stages)
        return ReadingDraft(articulation, asset, bundle, plan, findings, inspected)

    first = draft = made(first_plan(articulation, spare), "0")
    for attempt in range(config.max_rounds):
        late = stages.clock.busy > config.within_s
        repaired = (
            None if late else next_plan(draft.inspected, draft.plan, config, spare, draft.asset)
        )
        if repaired is None:
            break
        draft = made(repaired, str(attempt + 1))
    many = draft.asset.hull_count > stages.config.hulls.most
    if draft.passes and many:
        lighter = made(replace(draft.plan, fewer=True), "fewer")
        draft = lighter if lighter.passes else draft
    return draft if draft is first else replace(draft, before=first.asset)


def build_asset(source: Path, output: Path, config: BuildConfig) -> Result:
    """Make one input and register it in this process: ``factory build`` without its isolation.

    Args:
        source: a mesh, URDF or MJCF file.
        output: the registry's folder; a ``.cache`` of expensive stages lies in it too.
        config: every stage's settings.
    """
    registry = Registry(output, create=True)
    with registry.staging_folder() as staging, Judge(config.checks) as judge:
        return register(registry, make_asset(source, staging, config, output / CACHE, judge))
