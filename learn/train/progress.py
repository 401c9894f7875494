"""What people see of a run while it goes on: a bar on a terminal, a line now and then elsewhere."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import timedelta

from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from asset_factory.factory.runtime.terminal import Terminal


class Watch:
    """Tells how a run goes: on a bar where it is drawn, in plain lines elsewhere."""

    def __init__(self, progress: Progress, steps: int, done: int, batch: int) -> None:
        self._progress = progress
        self._task = progress.add_task("starting", total=steps, completed=done)
        self._steps = steps
        self._done = done
        self._batch = batch
        self._since = time.monotonic()
        self._waited = 0.0

    def waited(self, seconds: float) -> None:
        """Count the time a step waited for its samples."""
        self._waited += seconds

    def stepped(self, step: int, loss: float, rate: float) -> None:
        """Report progress after ``step`` steps; ``loss`` is a mean since the last call."""
        now = time.monotonic()
        took = max(now - self._since, 1e-9)
        steps = step - self._done
        speed = steps * self._batch / took
        waiting = self._waited / took
        said = f"loss {loss:.3f}  rate {rate:.1e}  {speed:.1f} samples/s  waiting {waiting:.0%}"
        self._progress.update(self._task, completed=step, description=said)
        if self._progress.disable:
            left = timedelta(seconds=round(took / steps * (self._steps - step)))
            self.say(f"step {step}/{self._steps}  {said}  left {left}")
        self._done = step
        self._since = now
        self._waited = 0.0

    def say(self, line: str) -> None:
        """Print a line, above the bar where there is one."""
        self._progress.console.print(line, markup=False, highlight=False, soft_wrap=True)


@contextmanager
def watching(steps: int, done: int, batch: int, quiet: bool) -> Iterator[Watch]:
    """Follow a run of so many steps of a batch, some done before; ``quiet`` says nothing."""
    console = Terminal(stderr=True, quiet=quiet)
    columns = (BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    said = TextColumn("{task.description}")
    drawn = console.is_terminal and not quiet
    with Progress(*columns, said, console=console, disable=not drawn) as progress:
        yield Watch(progress, steps, done, batch)
