"""What people see of a run while it goes on: a bar on a terminal, a line now and then elsewhere."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import timedelta

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TaskID,
    TextColumn,
    TimeRemainingColumn,
)

from asset_factory.factory.runtime.terminal import Terminal


class Watch:
    """Tells how a run goes: on the terminal's bar, or (``None``) in plain lines."""

    def __init__(
        self, console: Console, steps: int, done: int, bar: tuple[Progress, TaskID] | None
    ) -> None:
        self._console = console
        self._steps = steps
        self._bar = bar
        self._done = done
        self._since = time.monotonic()
        self._waited = 0.0
        self._samples = 0

    def waited(self, seconds: float, samples: int) -> None:
        """Count the time a step waited for its samples, and those."""
        self._waited += seconds
        self._samples += samples

    def stepped(self, step: int, loss: float, rate: float) -> None:
        """Report progress after ``step`` steps; ``loss`` is a mean since the last call."""
        now = time.monotonic()
        took = max(now - self._since, 1e-9)
        per_step = took / max(1, step - self._done)
        speed = self._samples / took
        waiting = self._waited / took
        said = f"loss {loss:.3f}  rate {rate:.1e}  {speed:.1f} samples/s  waiting {waiting:.0%}"
        if self._bar is not None:
            progress, task = self._bar
            progress.update(task, completed=step, description=said)
        else:
            left = timedelta(seconds=round(per_step * (self._steps - step)))
            self.say(f"step {step}/{self._steps}  {said}  left {left}")
        self._done = step
        self._since = now
        self._waited = 0.0
        self._samples = 0

    def say(self, line: str) -> None:
        """Print a line, above the bar where there is one."""
        self._console.print(line, markup=False, highlight=False, soft_wrap=True)


@contextmanager
def watching(steps: int, done: int, quiet: bool) -> Iterator[Watch]:
    """Follow a run of so many steps, some done before; all processes but the first are quiet."""
    console = Terminal(stderr=True, quiet=quiet)
    if quiet or not console.is_terminal:
        yield Watch(console, steps, done, None)
        return
    columns = (BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, TextColumn("{task.description}"), console=console) as progress:
        task = progress.add_task("starting", total=steps, completed=done)
        yield Watch(progress.console, steps, done, (progress, task))
