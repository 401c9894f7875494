"""The pipeline, in order: one input in, one registry entry out."""

from __future__ import annotations

from pathlib import Path

from asset_factory.sim_checks.isolation import Outcome
from asset_factory.sim_checks.judge import Judge

from .articulate.choose import articulate
from .clock import Stopwatch
from .config import BuildConfig
from .errors import InputRejected
from .export.bundle import export_bundle
from .load import load
from .manufacture import dispensable_joints, manufacture
from .registration import Made, register, register_failure, register_rejection
from .registry import Registry
from .repair import Plan, next_plan
from .result import Result
from .store import Store
from .validate import inspect, validate


def build_asset(source: Path, output: Path, config: BuildConfig) -> Result:
    """Make, judge, repair and register one input.

    Args:
        source: a mesh, URDF or MJCF file.
        output: the registry's folder; a ``.cache`` of expensive stages lies in it too.
        config: every stage's settings.

    Returns:
        What became of it. A bad input is a rejected result, never an exception.
    """
    registry, store, clock = Registry(output, create=True), Store(output / ".cache"), Stopwatch()
    try:
        with registry.staging_folder() as staging, Judge(config.checks) as judge:
            with clock.stage("load"):
                intake = load(source, config.intake)
            with clock.stage("articulate"):
                articulation = articulate(intake, config.articulator, config.particulate, config.auto)
            plan, spare = Plan(), dispensable_joints(articulation, config.repair.small_share)
            for attempt in range(1 + config.repair.max_rounds):
                asset, findings = manufacture(articulation, plan, intake, config, store, clock)
                with clock.stage("export"):
                    bundle = export_bundle(
                        asset, intake.provenance, staging / str(attempt), tuple(sorted(plan.exclude))
                    )
                with clock.stage("inspect"):
                    inspected = inspect(bundle, judge, findings)
                    repaired = next_plan(inspected, plan, config.repair, spare)
                if repaired is None or attempt == config.repair.max_rounds:
                    break
                plan = repaired
            with clock.stage("validate"):
                verdict = validate(bundle, config.simulators, judge, findings, inspected)
            made = Made(asset, bundle, verdict, plan)
            return register(registry, source, intake, made, clock)
    except InputRejected as rejection:
        return register_rejection(registry, source, rejection, clock)


def record_failure(source: Path, output: Path, outcome: Outcome[Result]) -> Result:
    """List an input whose process gave no result: unjudged, with what the process said last."""
    return register_failure(Registry(output, create=True), source, outcome, Stopwatch())
