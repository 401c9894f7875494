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

__all__ = ["Budget", "Call", "Executor", "LocalExecutor", "run_builds"]


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
