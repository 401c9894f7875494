"""How far a night is, at what rate, and how long it will still take."""

from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from time import monotonic

from rich.markup import escape
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

from asset_factory.sim_checks import Status

from ...registry.result import Result
from ...report.nightly.formats import clock_span
from ...runtime.terminal import Terminal, complain

#: Without a terminal there is a line every so often [s]; the rate is that of the last while [s].
EVERY_S = 60.0
WINDOW_S = 600.0


def followed(
    results: Iterable[Result], total: int, say: Callable[[str], None] | None = None
) -> Iterator[Result]:
    """Pass results on as they come, with a bar on a terminal and a line a minute elsewhere.

    There will be ``total`` results at most; ``say`` takes the lines instead of standard error.
    """
    console = Terminal(stderr=True)
    drawn = console.is_terminal and say is None
    say = say or complain
    columns = TextColumn("{task.description}"), BarColumn(), TextColumn("{task.fields[pace]}")
    marks = deque([(monotonic(), 0)])
    told = monotonic()
    with Progress(*columns, TimeElapsedColumn(), console=console, disable=not drawn) as bar:
        task = bar.add_task("building", total=total, pace="")
        for done, result in enumerate(results, start=1):
            marks.append((monotonic(), done))
            while marks[-1][0] - marks[0][0] > WINDOW_S and len(marks) > 2:
                marks.popleft()

            bar.update(
                task, advance=1, description=escape(result.entry.id), pace=pace(marks, total)
            )
            if drawn and result.entry.status is not Status.PASSED and not result.known:
                line = f"{result.entry.status}: {result.entry.id}: {result.entry.message}"
                console.print(line, markup=False, soft_wrap=True)
            elif not drawn and monotonic() - told >= EVERY_S:
                told = monotonic()
                say(pace(marks, total))
            yield result


def pace(marks: Sequence[tuple[float, int]], total: int) -> str:
    """Return e.g. ``120 of 1,000, 14.2 a minute, about 1 h 02 min left``.

    ``marks`` are times [s] and how many were done by then, the last one now.
    """
    (since, begun) = marks[0]
    (now, done) = marks[-1]
    told = f"{done:,} of {total:,}"
    if done == begun or now <= since:
        return told
    rate = (done - begun) / (now - since)
    return f"{told}, {60.0 * rate:.1f} a minute, about {clock_span((total - done) / rate)} left"
