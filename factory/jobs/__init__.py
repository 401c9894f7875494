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
        exchange: see :func:`~.ray.builds.ray_executor`.
    """
    if name == "local" or address == "local":
        workers = workers_for(workers, BUILD_BYTES)
    if name == "ray":
        from .ray.builds import ray_executor

        return ray_executor(config, workers=workers, address=address, exchange=exchange)
    return LocalExecutor(workers or 1, config.retries)


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
