"""Many builds: killable workers, nothing done twice, nothing lost.

:class:`~.job.Job` is the whole of it; :func:`run_builds` a job on this machine.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from ..config import BuildConfig
from ..registry.result import Result
from .budget import Budget
from .executor import Call, Executor
from .local import LocalExecutor
from .memory import BUILD_BYTES, workers_for

__all__ = ["Budget", "Call", "Executor", "LocalExecutor", "executor_for", "run_builds"]


def executor_for(
    config: BuildConfig, name: str, workers: int | None, address: str, exchange: str
) -> Executor:
    """Return the executor of builds that users ask for.

    Args:
        config: of the builds.
        name: ``local``, or ``ray``.
        workers: ``None``: as many as this machine, or the cluster, has room for.
        address: of a Ray cluster, see :class:`~.ray.executor.RayExecutor`.
        exchange: fsspec's URL through which bundles come back; inputs and checkpoints are sent to
            nodes then. It is empty if the registry's folder and the inputs lie where all nodes see
            them, which also lets them share a cache.
    """
    if name == "local" or address == "local":
        workers = workers_for(workers, BUILD_BYTES)
    if name == "local":
        return LocalExecutor(workers or 1, config.retries)
    # Ray, and the geometry libraries, load only to build on a cluster.
    from ..articulate.catalog import entry_of
    from .job import modules_for
    from .ray.executor import RayExecutor

    return RayExecutor(
        workers=workers,
        address=address,
        retries=config.retries,
        modules=modules_for(config),
        exchange=exchange,
        network=config.particulate if entry_of(config.articulator).asks_network else None,
    )


def run_builds(
    inputs: Sequence[Path],
    output: Path,
    config: BuildConfig,
    workers: int = 1,
    budget: Budget | None = None,
) -> Iterator[Result]:
    """Build every input on this machine; yield results as they come."""
    # Geometry libraries load only to build.
    from .job import Job

    return Job(inputs, output, config, LocalExecutor(workers, config.retries), budget).run()
