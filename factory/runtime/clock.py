"""Wall-clock time by stage, for summaries; never for artefacts."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from time import perf_counter

from asset_factory.sim_checks.processes.place import at


class Stopwatch:
    """Adds up how long each stage took.

    Attributes:
        stages: seconds by stage, in the order in which they were first entered.
    """

    def __init__(self) -> None:
        self._started = perf_counter()
        self._within = 0.0
        self.stages: dict[str, float] = {}

    @property
    def seconds(self) -> float:
        """Return the time since construction [s]."""
        return perf_counter() - self._started

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Count time spent inside for ``name``, except stages within; also when it raises."""
        started = perf_counter()
        within = self._within
        self._within = 0.0
        try:
            # Should the process die in it, the stage is known.
            with at(name):
                yield
        finally:
            seconds = perf_counter() - started
            self.stages[name] = self.stages.get(name, 0.0) + seconds - self._within
            self._within = within + seconds
