"""The pipeline, in order: one input in, one registry entry out."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from asset_factory.sim_checks import Finding
from asset_factory.sim_checks.judge import Judge

from .articulate.standing import standing_hypotheses
from .articulate.terms import with_terms
from .articulation import Articulation
from .config import BuildConfig
from .errors import InputRejected, Unjudged
from .export.bundle import with_manifest_of, write_input, write_model
from .intake.intake import Intake
from .intake.source import Source
from .manufacture.stage import with_targets
from .registry import Registry
from .registry.product import Product, finished, refused
from .registry.registration import register
from .registry.result import Result
from .runtime.layout import CACHE
from .runtime.stages import Stages
from .runtime.store import Store
from .verify.drafts import HypothesisDraft, best_of, refused_hypothesis
from .verify.kept import with_kept
from .verify.rounds import Rounds


def make_asset(
    source: Path,
    staging: Path,
    config: BuildConfig,
    cache: Path | None,
    judge: Judge,
    place: Path | None = None,
) -> Product:
    """Make, validate and repair one input; register nothing.

    Args:
        source: a mesh, URDF or MJCF file.
        staging: an empty folder to work in.
        config: every stage's settings.
        cache: where results of expensive stages are kept; ``None``: nowhere.
        judge: the validator, with the configuration's thresholds.
        place: where the input lies for whoever registers it, if that is elsewhere.

    Returns:
        The product to register. A bad input is a rejected product, and one that a clock stopped
        an unjudged one, never an exception.
    """
    stages = Stages(config, Store(cache) if cache else None)
    origin = Source(source, config, place)
    intake: Intake | None = None
    try:
        with stages.clock.stage("load"):
            intake = origin.load()
        intake, likeliest_first = standing_hypotheses(intake, origin, stages)
        intake = with_terms(intake, likeliest_first, config.intake.allowed_licenses)
        refused_too: list[Finding] = []
        drafts = _drafts(likeliest_first, intake, staging, judge, stages, refused_too)
        draft, others = best_of(drafts)
        rounds = Rounds(draft.articulation, intake, staging, judge, stages)
        draft, verdict = rounds.simulated(draft, (*others, *refused_too))
        verdict = with_kept(verdict, draft.articulation, draft.asset.articulation)
        # No check asks for them: they are looked for once, on the draft that is kept.
        asset = with_targets(draft.asset, stages)
        bundle = with_manifest_of(draft.bundle, asset, intake.provenance)
        with stages.clock.stage("model"):
            write_model(asset, bundle.folder, draft.before)
        return finished(origin, intake, bundle, verdict, draft.plan.repairs, stages)
    except (InputRejected, Unjudged) as ended:
        shown = None if intake is None else write_input(intake.mesh, staging / "input")
        return refused(origin, ended, stages, shown)


def _drafts(
    likeliest_first: tuple[Articulation, ...],
    intake: Intake,
    staging: Path,
    judge: Judge,
    stages: Stages,
    refused_too: list[Finding],
) -> Iterator[HypothesisDraft]:
    """Yield each hypothesis as an asset, repaired and validated, up to so much work.

    Those of which no bodies can be made are added to ``refused_too``.
    """
    limits = stages.config.readings
    refused_first: InputRejected | None = None
    done = 0
    for number, hypothesis in enumerate(likeliest_first[: limits.most]):
        if done > limits.most_work:
            break
        try:
            rounds = Rounds(hypothesis, intake, staging / str(number), judge, stages)
            draft = rounds.drafted()
        except InputRejected as rejection:
            refused_first = refused_first or rejection
            refused_too.append(refused_hypothesis(hypothesis, rejection))
            continue
        done += draft.work
        yield draft
    if refused_first is not None and not done:
        raise refused_first


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
