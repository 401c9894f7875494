"""What people see in a terminal: progress, tables, reports."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from datetime import timedelta
from pathlib import Path
from typing import TYPE_CHECKING, Any

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
from rich.table import Column, Table
from rich.text import Text

from asset_factory.sim_checks import Disagreement, Finding, Report, Severity, Status
from asset_factory.sim_checks.grouping import group_disagreements, group_findings

from ..registry import Entry
from ..registry.result import Result
from ..report.nightly.formats import clock_span
from ..report.summary import Summary
from ..runtime.layout import ASSETS, MODEL, REJECTED, SUMMARY
from ..runtime.terminal import Terminal, one_line

if TYPE_CHECKING:
    from ..export.manifest import Manifest
    from ..jobs.executor import UnderWay

STATUS_STYLE = {Status.PASSED: "green", Status.REJECTED: "red", Status.UNJUDGED: "yellow"}
_STYLES = {Severity.ERROR: "red", Severity.WARNING: "yellow", Severity.NOTE: "blue"}
#: In a table of more inputs than this, those known from before are left out.
LISTED = 100
#: Inputs at work that are named beside the bar.
SHOWN_AT_WORK = 3
#: The rate that is said is that of the last while [s].
WINDOW_S = 600.0
#: Columns of a terminal that a list wants beside its ids; in a narrower one its lines are broken.
LEAST_BESIDE = 52


def follow(
    results: Iterable[Result],
    total: int,
    under_way: Callable[[], tuple[UnderWay, ...]] = tuple,
    *,
    quiet: bool = False,
    every_s: float | None = None,
) -> Iterator[Result]:
    """Pass results on as they come, with a progress bar on a terminal and plain lines elsewhere.

    What was known from before is counted, not told one by one; rate and time left are those of the
    rest.

    Args:
        results: at most ``total``.
        total: how many inputs there are.
        under_way: asked what workers are at.
        quiet: print nothing.
        every_s: without a terminal, say so often how far it is [s], in place of a line for each
            result.
    """
    console = Terminal(stderr=True, quiet=quiet)
    drawn = console.is_terminal
    amounts = (BarColumn(bar_width=20), MofNCompleteColumn(), TimeElapsedColumn())
    columns = (*amounts, _TimeLeft(), _Stages(under_way))
    known = 0
    done = 0
    with Progress(
        *columns, console=console, disable=not drawn, speed_estimate_period=WINDOW_S
    ) as progress:
        task = progress.add_task("building", total=total)
        told = progress.get_time()
        for done, result in enumerate(results, start=1):
            known += result.known
            progress.update(task, total=total - known, advance=not result.known)
            line = f"{result.entry.status}: {_sentence(result)}"
            if drawn:
                if not result.known and (
                    result.entry.status is not Status.PASSED or result.replaced
                ):
                    console.print(line, markup=False)
            elif every_s is not None:
                if progress.get_time() - told >= every_s:
                    told = progress.get_time()
                    console.print(pace(done, total, progress.tasks[0].speed), markup=False)
            elif not result.known:
                if 0 < known == done - 1:
                    console.print(_known_sentence(known, total), markup=False)
                console.print(f"[{done}/{total}] {line}", markup=False, soft_wrap=True)
            yield result
    if not drawn and every_s is None and 0 < known == done:
        console.print(_known_sentence(known, total), markup=False)


def pace(done: int, total: int, speed: float | None) -> str:
    """Return e.g. ``120 of 1,000, 14.2 a minute, about 1 h 02 min left``; speed is in 1/s."""
    told = f"{done:,} of {total:,}"
    if not speed:
        return told
    return f"{told}, {60.0 * speed:.1f} a minute, about {clock_span((total - done) / speed)} left"


class _Stages(ProgressColumn):
    """What workers are at, as the bar is drawn: inputs, each with its stage."""

    max_refresh = 0.5

    def __init__(self, under_way: Callable[[], tuple[UnderWay, ...]]) -> None:
        self._under_way = under_way
        super().__init__()

    def render(self, task: Task) -> Text:
        """Return the first few; the rest is counted."""
        found = self._under_way()
        told = [f"{Path(each.name).name} {each.place}".strip() for each in found[:SHOWN_AT_WORK]]
        more = f" +{len(found) - len(told)}" if len(found) > len(told) else ""
        return Text(one_line(", ".join(told)) + more or task.description)


class _TimeLeft(ProgressColumn):
    """How long the rest will take, once one input is done: as long for each as so far."""

    max_refresh = 0.5

    def render(self, task: Task) -> Text:
        """Return nothing until something is known."""
        if not task.completed or task.total is None or task.elapsed is None:
            return Text("")
        left = task.elapsed / task.completed * (task.total - task.completed)
        return Text(f"about {timedelta(seconds=round(left))} left")


@contextmanager
def counted(what: str) -> Iterator[Callable[[int, int], None]]:
    """Show a progress bar on a terminal, nothing elsewhere; it is told how many are done."""
    console = Terminal(stderr=True)
    columns = (TextColumn(what), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=console, disable=not console.is_terminal) as progress:
        task = progress.add_task(what, total=None)
        yield lambda done, total: progress.update(task, completed=done, total=total)


def _known_sentence(known: int, total: int) -> str:
    return f"{known} of {total} inputs known from before"


def _sentence(result: Result) -> str:
    said = f"{result.entry.id}: {result.entry.message}" if result.entry.message else result.entry.id
    replaced = f"; in place of {', '.join(result.replaced)}" if result.replaced else ""
    return one_line(f"{said}{replaced}")


def print_results(summary: Summary, output: Path) -> None:
    """Print the table at the end of a build, and where to look."""
    from ..intake.formats.catalog import is_mesh

    console = terminal()
    whole = Column("asset", no_wrap=True)
    table = Table(whole, "parts", "joints", "hulls", "verdict", "reason")
    results = sorted(summary.results, key=lambda result: result.input)
    listed = results if len(results) <= LISTED else [each for each in results if not each.known]
    for result in listed:
        entry = result.entry
        table.add_row(escape(entry.id), *_told(entry), escape(entry.message))
    if listed:
        console.print(table)
    if len(listed) < len(results):
        console.print(f"{len(results) - len(listed)} known from before: in {SUMMARY}.")
    console.print(
        f"{len(results)} inputs: {summary.count(Status.PASSED)} passed, "
        f"{summary.count(Status.REJECTED)} rejected, "
        f"{summary.count(Status.UNJUDGED)} could not be validated.",
        soft_wrap=True,
    )
    where = f"Assets: {output / ASSETS}   reports of the others: {output / REJECTED}"
    console.print(where, soft_wrap=True, markup=False)
    rejected = [each for each in listed if each.entry.status is Status.REJECTED]
    folders = [output / each.entry.folder for each in rejected if is_mesh(Path(each.input))]
    # Of a mesh that could not be read there is nothing to draw on.
    edited = next((folder for folder in folders if (folder / MODEL).is_file()), None)
    if edited is not None:
        console.print(f"To say what opens: factory edit {edited}", soft_wrap=True, markup=False)


def print_prediction(data: dict[str, Any]) -> None:
    """Print what :func:`~asset_factory.factory.articulate.predict.predict` says of an input."""
    console = terminal()
    if "rejected" in data:
        rejected = data["rejected"]
        console.print(f"rejected: {rejected['code']}: {rejected['message']}", markup=False)
        return
    parts = Table("part", "faces", "confidence")
    for part in data["parts"]:
        parts.add_row(escape(part["name"]), str(part["faces"]), _or_dash(part["confidence"]))
    joints = Table("joint", "type", "parent", "child", "axis", "origin [m]", "limits", "confidence")
    for joint in data["joints"]:
        ends = (escape(joint["parent"]), escape(joint["child"]))
        line = (" ".join(f"{x:.3f}" for x in joint[name]) for name in ("axis", "origin"))
        limits = f"{joint['lower']:.3f} to {joint['upper']:.3f} {joint['unit']}"
        told = (*ends, *line, limits, _or_dash(joint["confidence"]))
        joints.add_row(escape(joint["name"]), joint["type"], *told)
    console.print(parts, joints)
    for note in data["notes"]:
        console.print(note, markup=False, soft_wrap=True)


def _or_dash(value: float | None) -> str:
    return "-" if value is None else f"{value:.2f}"


def print_report(
    report: Report, findings: Sequence[Finding] | None = None, *, verbose: bool = True
) -> None:
    """Print one checked file: its verdict and findings, all of them or the worst of each code.

    ``findings`` are those to tell where others were told of the same asset; all by default.
    """
    console = terminal()
    verdict = report.status
    engines = ", ".join(report.simulators) or "no simulator"
    coloured = f"[{STATUS_STYLE[verdict]}]{verdict}[/]"
    console.print(f"{coloured} {escape(report.description)} [dim]({engines})[/]", soft_wrap=True)
    told = report.findings if findings is None else findings
    for group in group_findings(told):
        for finding in group if verbose else group[:1]:
            line = _finding_line(finding, 1 if verbose else len(group))
            console.print(f"  {line}", soft_wrap=True)
    if len(told) < len(report.findings):
        same = len(report.findings) - len(told)
        console.print(f"  [dim]and {same} as in another file of this asset, above[/]")
    for alike in group_disagreements(report.disagreements):
        for disagreement in alike if verbose else alike[:1]:
            line = _disagreement_line(disagreement, 0 if verbose else len(alike) - 1)
            console.print(f"  {line}", soft_wrap=True)


def _disagreement_line(disagreement: Disagreement, more: int) -> str:
    answers = []
    for simulator, verdict in disagreement.verdicts.items():
        value = disagreement.values.get(simulator)
        told = "" if value is None else f" ({_figure(value, disagreement.unit)})"
        answers.append(f"{simulator} {verdict}{told}")
    others = f" (so for {more} more joint{'s' if more > 1 else ''})" if more else ""
    return (
        f"[cyan]disagree[/] {escape(disagreement.asked + others)}: {escape(', '.join(answers))}; "
        f"{escape(disagreement.reason)}"
    )


def _figure(value: float, unit: str | None) -> str:
    return f"{100.0 * value:.3g}% of range" if unit == "of range" else f"{value:.4g} {unit}"


def _finding_line(finding: Finding, count: int) -> str:
    # Most sentences about an engine begin with its name.
    named = finding.simulator is None or finding.message.startswith(finding.simulator)
    where = "" if named else f" [{finding.simulator}]"
    many = f" ({count} of them, the worst)" if count > 1 else ""
    told = f"{finding.code}{where}{many}: {finding.message}"
    return f"[{_STYLES[finding.severity]}]{finding.severity}[/] {escape(told)}"


def print_entries(listed: Sequence[tuple[Entry, Manifest | None]]) -> None:
    """Print rows of a registry with their manifests; ids are whole however narrow the terminal."""
    console = terminal()
    whole = [Column(name, no_wrap=True) for name in ("size [m]", "joints", "hulls")]
    ends = [Column(name, overflow="fold") for name in ("category", "verdict")]
    table = Table(Column("id", no_wrap=True), ends[0], *whole, ends[1], box=None, pad_edge=False)
    for entry, manifest in listed:
        _, *counts, status = _told(entry)
        size = manifest.size.replace(" ", "") if manifest else "-"
        verdict = f"{status}: {escape(entry.reason)}" if entry.reason else status
        table.add_row(escape(entry.id), escape(entry.category), size, *counts, verdict)
    longest = max((len(entry.id) for entry, _ in listed), default=0)
    console.width = max(console.width, longest + LEAST_BESIDE)
    console.print(table)


def _told(entry: Entry) -> tuple[str, ...]:
    """Return an entry's counts and its coloured status, for a table."""
    counts = (entry.parts, entry.joints, entry.hulls)
    return *map(str, counts), f"[{STATUS_STYLE[entry.status]}]{entry.status}[/]"


def terminal() -> Console:
    """Return where people look: standard output, as wide as it is."""
    console = Terminal()
    # A pipe or a log file has no width; a table squeezed into 80 columns there would cut the
    # reasons.
    return console if console.is_terminal else Terminal(width=200)
