"""What a night calls upon, as this package does it."""

from __future__ import annotations

from pathlib import Path

from asset_factory.sim_checks.processes.isolation import processors

from ... import jobs
from ...intake.discover import find_inputs
from ...registry import Registry
from ...registry.cleaning import collect_garbage
from ...registry.verify import verify
from .. import Executor, LocalExecutor
from ..job import Job
from .morning import Damage
from .outcome import count
from .progress import followed
from .run import Verified, Works
from .settings import LOCAL, Budget, NightConfig, Upkeep

_HOUR_S, _DAY_S, _GIGA = 3600.0, 86400.0, 1e9


def works_of(config: NightConfig) -> Works:
    """The works that a configuration asks for; makes the registry where there is none."""
    registry = Registry(config.output, create=True)
    return Works(
        find=lambda: find_inputs(config.inputs),
        begin=lambda paths: _job(paths, config),
        verify=lambda: _verified(registry),
        tidy=lambda: _tidied(config.output, config.upkeep),
        entries=lambda: tuple(registry.walk()),
        follow=followed,
        settings=_told(config),
    )


def _job(paths: tuple[Path, ...], config: NightConfig) -> Job:
    here = config.executor == LOCAL
    return Job(
        paths,
        config.output,
        config.build,
        _executor(config),
        _budget(config.budget),
        one_network=here,
    )


def _executor(config: NightConfig) -> Executor:
    if config.executor == LOCAL:
        return LocalExecutor(config.workers or processors(), config.build.retries)
    from ..ray.builds import ray_executor

    address = config.ray_address
    return ray_executor(
        config.build, workers=config.workers or None, address=address, exchange=config.exchange
    )


def _budget(budget: Budget) -> jobs.Budget:
    longest = _HOUR_S * budget.max_hours
    return jobs.Budget(
        limit=budget.limit or None, max_s=longest or None, retry=budget.retry_rejected
    )


def _verified(registry: Registry) -> Verified:
    problems = verify(registry)
    return Verified(
        registry.count(), tuple(Damage(item.id, item.kind, item.message) for item in problems)
    )


def _tidied(output: Path, upkeep: Upkeep) -> str:
    freed = collect_garbage(
        output,
        older_than_s=_DAY_S * upkeep.cache_days or None,
        keep_bytes=round(_GIGA * upkeep.cache_gb) or None,
    )
    left, cached = (
        count(freed.staging.files + freed.unfinished.files, "thing"),
        count(freed.cache.files, "cached result"),
    )
    return f"{left} that dead processes left, {cached}; {freed.bytes:,} bytes"


def _told(config: NightConfig) -> dict[str, str]:
    return {
        "simulators": ", ".join(config.build.simulators),
        "articulator": config.build.articulator,
        "preset": Path(config.preset).name,
        "executor": config.executor,
        "workers": str(config.workers or "all processors"),
        "licences": ", ".join(config.licences.allowed) or "any",
    }
