"""How far a night is, at what rate, and how long it will still take."""

from __future__ import annotations

import sys
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from time import monotonic

from rich.console import Console
from rich.markup import escape
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    ProgressColumn,
    Task,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)
from rich.text import Text

from ...registry.result import Result
from .words import clock_span

#: Lines of a night without a terminal come this far apart [s]; the rate is that of the last few of
#: them.
EVERY_S, WINDOW_S = 60.0, 600.0


def followed(
    results: Iterable[Result], total: int, say: Callable[[str], None] | None = None
) -> Iterator[Result]:
    """Give results on as they come, with a bar on a terminal and a line a minute elsewhere.

    Args:
        results: in order of completion.
        total: how many there will be at most.
        say: takes the lines where there is no terminal; standard error by default.
    """
    console = Console(stderr=True)
    if console.is_terminal and say is None:
        yield from _with_bar(results, total, console)
    else:
        yield from _with_lines(
            results, total, say or (lambda line: print(line, file=sys.stderr, flush=True))
        )


def pace(marks: Sequence[tuple[float, int]], total: int) -> str:
    """``120 of 1,000, 14.2 a minute, about 1 h 02 min left``.

    Args:
        marks: times [s] and how many were done by then, the last one now.
        total: how many there are.
    """
    (since, begun), (now, done) = marks[0], marks[-1]
    told = f"{done:,} of {total:,}"
    if done == begun or now <= since:
        return told
    rate = (done - begun) / (now - since)
    return f"{told}, {60.0 * rate:.1f} a minute, about {clock_span((total - done) / rate)} left"


def _with_lines(
    results: Iterable[Result], total: int, say: Callable[[str], None]
) -> Iterator[Result]:
    marks, told = deque([(monotonic(), 0)]), monotonic()
    for done, result in enumerate(results, start=1):
        marks.append((monotonic(), done))
        while marks[-1][0] - marks[0][0] > WINDOW_S and len(marks) > 2:
            marks.popleft()
        if monotonic() - told >= EVERY_S:
            told = monotonic()
            say(pace(marks, total))
        yield result


def _with_bar(results: Iterable[Result], total: int, console: Console) -> Iterator[Result]:
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        _Rate(),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=console) as progress:
        task = progress.add_task("building", total=total)
        for result in results:
            progress.update(task, advance=1, description=escape(result.entry.id))
            if result.entry.status != "passed" and not result.known:
                told = f"{result.entry.status}: {result.entry.id}: {result.entry.message}"
                progress.console.print(told, markup=False, soft_wrap=True)
            yield result


class _Rate(ProgressColumn):
    """Inputs a minute."""

    def render(self, task: Task) -> Text:
        speed = task.finished_speed or task.speed
        return Text("" if speed is None else f"{60.0 * speed:.1f}/min", style="progress.data.speed")
