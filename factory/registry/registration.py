"""A product, or the lack of one, becomes a registry entry and a result."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from time import perf_counter

from asset_factory.sim_checks import Finding, Severity, Status
from asset_factory.sim_checks.processes.isolation import Failure, Outcome
from asset_factory.sim_checks.report import OUT_OF_TIME

from ..config import BuildConfig
from ..intake.reads import Reads
from ..intake.source import Source
from . import Registry
from .aside import InputNow, keep_current
from .crashes import ALWAYS, ONCE, crash_measurements, crash_stage, sentence
from .product import Product, without_asset
from .result import Result


def register(registry: Registry, product: Product, attempts: int = 1) -> Result:
    """Publish what passed, keep the report of what did not, and say which.

    The product's bundle is in one of the registry's staging folders, and is gone afterwards.

    Raises:
        OSError: the registry cannot be written; nothing is half-published.
    """
    started = perf_counter()
    entry = product.entry
    # An earlier attempt may have ended before the input's own digest was known; it cannot have
    # passed.
    for earlier in product.unloaded_ids:
        if (registry.rejected / earlier).exists():
            registry.forget(earlier, except_id=entry.id)
    registry.add(entry, product.told, product.bundle)
    source = Path(product.result.input)
    digest = product.reads.get(source.name, "")
    judged = digest and entry.status is not Status.UNJUDGED
    now = (InputNow(source, digest, entry.id),) if judged else ()
    replaced = keep_current(registry, now)
    seconds = perf_counter() - started
    result = product.result
    return replace(
        result,
        seconds=result.seconds + seconds,
        stages={**result.stages, "register": seconds},
        attempts=attempts,
        replaced=replaced,
    )


def register_failure(
    registry: Registry, source: Path, reads: Reads, config: BuildConfig, outcome: Outcome[Product]
) -> Result:
    """Keep the report of an input whose process crashed, hung or met a bug of ours.

    ``reads`` are the files that it is made of, if they are known; what died twice in one stage is
    then not tried again until one of them, the settings or a library changes, or somebody asks for
    it. What ran out of time, or died once, may have been bad luck: the next job tries again.
    """
    origin = Source(source, config)
    origin.reads = reads
    stage = crash_stage(registry, origin.id, outcome)
    late = outcome.failure is Failure.TIMEOUT
    code = "build_timeout" if late else ALWAYS if stage else ONCE
    message = f"building {source.name}: {sentence(outcome, stage)}"
    finding = Finding(code, Severity.ERROR, message, cause=OUT_OF_TIME if late else None)
    bad_luck = outcome.failure is Failure.CRASHED and not stage
    origin.keyed = not (bad_luck or isinstance(outcome.error, OSError))
    entry, told = without_asset(origin, finding, Status.UNJUDGED)
    measurements = crash_measurements(outcome)
    told = replace(told, report=replace(told.report, measurements=measurements))
    registry.add(entry, told)
    return Result(str(source), entry, seconds=outcome.seconds, attempts=outcome.tries)
