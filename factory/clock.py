"""Wall-clock time by stage, for summaries; never for artefacts."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from time import perf_counter


class Stopwatch:
    """Adds up how long each stage took.

    Attributes:
        stages: seconds by stage, in the order in which they were first entered.
    """

    def __init__(self) -> None:
        self._started = perf_counter()
        self.stages: dict[str, float] = {}

    @property
    def seconds(self) -> float:
        """Since construction [s]."""
        return perf_counter() - self._started

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Time spent inside belongs to ``name``, also when it raises."""
        started = perf_counter()
        try:
            yield
        finally:
            self.stages[name] = self.stages.get(name, 0.0) + perf_counter() - started
