"""What a night calls upon."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from datetime import UTC, datetime
from functools import cached_property
from pathlib import Path

from ...intake.discover import find_inputs
from ...intake.mirror import local_inputs
from ...registry import Registry
from ...registry.cleaning import collect_garbage
from ...registry.result import Result
from ...report.nightly.formats import counted
from .. import Budget, Executor, executor_for
from ..job import Job
from .settings import NightConfig

_HOUR_S = 3600.0
_DAY_S = 86400.0


class Work:
    """The steps of a night as its configuration wants them; makes the registry if there is none.

    Args:
        config: of the night.
        follow: passes results on as they come, and shows how far the night is; it is given them,
            how many there are at most, and what tells what workers are at.
    """

    def __init__(
        self,
        config: NightConfig,
        follow: Callable[..., Iterable[Result]] = lambda results, *_: results,
    ) -> None:
        self._config = config
        self.follow = follow

    @cached_property
    def registry(self) -> Registry:
        """Return the registry."""
        return Registry(self._config.output, create=True)

    @property
    def settings(self) -> dict[str, str]:
        """Return how the night is run, as its report tells it."""
        config = self._config
        return {
            "simulators": ", ".join(config.build.simulators),
            "articulator": config.build.articulator,
            "preset": Path(config.preset).name,
            "executor": config.executor,
            "workers": str(config.workers or "as many as fit"),
            "licenses": ", ".join(config.licenses.allowed) or "any",
        }

    def now(self) -> datetime:
        """Return the time."""
        return datetime.now(UTC)

    def find(self) -> tuple[Path, ...]:
        """Return all inputs; those behind URLs are fetched."""
        return find_inputs(local_inputs(self._config.inputs, self._config.output))

    def job(self, inputs: tuple[Path, ...], damaged: frozenset[str] = frozenset()) -> Job:
        """Return the job over some inputs; those of damaged assets are built again, and first."""
        config = self._config
        budget = replace(self.budget(), damaged=damaged)
        return Job(inputs, config.output, config.build, self.executor(), budget)

    def executor(self) -> Executor:
        """Return where workers run."""
        config = self._config
        place = (config.ray_address, config.exchange)
        return executor_for(config.build, config.executor, config.workers or None, *place)

    def budget(self) -> Budget:
        """Return how much the job does."""
        budget = self._config.budget
        longest = _HOUR_S * budget.max_hours
        return Budget(budget.limit or None, longest or None, budget.retry_rejected)

    def tidy(self) -> str:
        """Remove what nobody needs; says what that was."""
        upkeep = self._config.upkeep
        freed = collect_garbage(
            self._config.output,
            older_than_s=_DAY_S * upkeep.cache_days or None,
            keep_bytes=round(1e9 * upkeep.cache_gb) or None,
        )
        left = counted(freed.staging.files + freed.unfinished.files, "thing")
        cached = counted(freed.cache.files, "cached result")
        return f"{left} that dead processes left, {cached}; {freed.bytes:,} bytes"
