"""One night, in order: tidy, verify, build and mend, compare, report."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import cast

from asset_factory.sim_checks import Status

from ...errors import AssetFactoryError, RegistryError
from ...intake.mirror import mirror_of
from ...registry import Entry
from ...registry.diff import diff
from ...registry.result import Result
from ...registry.verify import Problem, Settled, mend_rows, settle, verify
from ...report.nightly import files
from ...report.nightly.figures import compare, source_yields
from ...report.nightly.formats import counted, stamp
from ...report.nightly.night import Night, NightResult, attempt_of, latest, tally
from ...report.nightly.outcome import concerns, exit_code
from ...report.nightly.report import NightlyReport
from ...report.nightly.table import read_table
from ...report.summary import JobState
from ...runtime.layout import NIGHTS
from ..job import Job
from .journal import journal, locked, log, read_journal
from .licenses import sort_out
from .settings import NightConfig
from .work import Work


def run_night(
    config: NightConfig,
    work: Work,
    *,
    name: str | None = None,
    fresh: bool = False,
) -> NightlyReport:
    """Run a night, or go on with one that was interrupted.

    An interruption (KeyboardInterrupt) ends it early with a page of its own, and the next run goes
    on with it; so it does after the process was killed, with all that was finished.

    ``name`` is by default that of the night that goes on, else the next number; ``fresh`` begins a
    new one, and interrupted ones stay as they are.

    Raises:
        ConfigError: another night runs on this output, or the name cannot be.
        RegistryError: the output cannot be written any more; the next run goes on.
    """
    found = work.find()
    nights = config.output / NIGHTS
    files.chosen_name(nights, name)  # Before anything is made.
    with _writable(nights):
        nights.mkdir(parents=True, exist_ok=True)
        with locked(nights) as announce:
            if fresh:
                for left in files.unfinished(nights):
                    close(nights / left, config)
            folder = nights / files.chosen_name(nights, name)
            announce(folder.name)
            folder.mkdir(exist_ok=True)
            (folder / files.JOURNAL).touch()
            with log(folder / files.LOG, work.now) as write:
                report = _NightRun(folder, config, work, write).report(found)
                told = " ".join(report.attention) or "all is well"
                write(f"ends with exit code {report.night.exit_code}: {told}")
            return report


@contextmanager
def _writable(nights: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        why = f"{error.filename or nights}: {error.strerror or error}"
        kept = "what was finished is registered, and the next run goes on"
        raise RegistryError(f"{why}; {kept}") from error


def close(folder: Path, config: NightConfig) -> None:
    """Leave an interrupted night as it is: with a page, and never gone on with."""
    tried = read_journal(folder / files.JOURNAL)
    started = min((attempt.started for attempt in tried), default="")
    killed = Night(folder.name, JobState.INTERRUPTED, started, started, **tally(latest(tried)))
    killed = replace(killed, found=killed.attempted)
    report = NightlyReport(files.read_night(folder) or killed, tried=tried)
    files.publish(folder, _compared(report, folder.parent, config))
    (folder / files.JOURNAL).unlink()


@dataclass
class _Done:
    """How far a run of a night came; ``damage`` is ``None`` where nothing was verified."""

    state: JobState = JobState.FINISHED
    damage: tuple[Problem, ...] | None = None
    settled: dict[str, Settled] = field(default_factory=dict)


@dataclass(frozen=True)
class _NightRun:
    """One run of a night; earlier ones may have been interrupted."""

    folder: Path
    config: NightConfig
    work: Work
    write: Callable[[str], None]

    def report(self, found: Sequence[Path]) -> NightlyReport:
        """Build, verify and tidy, compare with the night before, and publish."""
        began = self.work.now()
        earlier = files.read_night(self.folder)
        rows = tuple(self.work.registry.walk())
        tried = list(read_journal(self.folder / files.JOURNAL))
        told = ", ".join(f"{name}: {value}" for name, value in self.work.settings.items())
        begins = "goes on" if tried or earlier else "begins"
        self.write(f"night {self.folder.name} {begins}: {told}")

        inputs, left_out = sort_out(found, self.config.licenses)
        self.write(f"{counted(len(found), 'input')}, {len(left_out)} left out for their license")
        done = self._do(inputs, tried)

        kept = tuple(self.work.registry.walk())
        attempts = latest(tried)
        first = min([stamp(began), *(attempt.started for attempt in tried)])
        ended = self.work.now()
        seconds = (ended - began).total_seconds() + (earlier.seconds if earlier else 0.0)
        night = Night(
            self.folder.name,
            done.state,
            started=earlier.started if earlier else first,
            ended=stamp(ended),
            seconds=round(seconds, 3),
            found=len(found),
            waiting=max(0, len(inputs) - len(attempts)),
            left_out=len(left_out),
            verified=None if done.damage is None else len(rows),
            damaged=len({problem.id for problem in done.damage or ()}),
            mended=[*done.settled.values()].count(Settled.MENDED),
            withdrawn=[*done.settled.values()].count(Settled.WITHDRAWN),
            **tally(attempts),
        )
        passed = [entry for entry in kept if entry.status is Status.PASSED]
        report = NightlyReport(
            night,
            tried=tuple(tried),
            damage=done.damage or (),
            settled=done.settled,
            left_out=left_out,
            not_allowed=tuple(e for e in passed if not self.config.licenses.allow(e.license)),
            registry=_row_changes(rows, kept),
            settings=self.work.settings,
        )
        report = _compared(report, self.folder.parent, self.config)
        files.publish(self.folder, report)
        if done.state != JobState.INTERRUPTED:
            (self.folder / files.JOURNAL).unlink()
        return report

    def _do(self, inputs: tuple[Path, ...], tried: list[NightResult]) -> _Done:
        """Tidy, verify, build and mend; adds to ``tried``."""
        done = _Done()
        try:
            self._tidy()
            if self.config.verify:
                done.damage = verify(self.work.registry)
                self.write(f"verified, found {counted(len(done.damage), 'problem')}")
            mending = (done.damage or ()) if self.config.mend else ()
            mend_rows(self.work.registry, mending)

            # What is damaged comes first: a night that runs out of time has mended it.
            job = self.work.job(inputs, frozenset(problem.id for problem in mending))
            self._build(job, len(inputs), tried)
            done.state = job.state
            final = job.state == JobState.FINISHED
            done.settled = settle(self.work.registry, mending, final=final)
            for asset_id, became in done.settled.items():
                self.write(f"{became}: {asset_id}")
            self._tidy()
        except KeyboardInterrupt:
            self.write("interrupted")
            done.state = JobState.INTERRUPTED
        except AssetFactoryError as error:
            self.write(f"cannot go on: {error}")
            raise
        return done

    def _tidy(self) -> None:
        """Clear what dead processes left: before the night for room, after it for the cache."""
        if self.config.upkeep.enabled:
            self.write(f"tidied: {self.work.tidy()}")

    def _build(self, job: Job, total: int, tried: list[NightResult]) -> None:
        results = cast("Generator[Result]", job.run())
        # Closed: workers hear of an interruption now, not when the job is no longer referred to.
        with journal(self.folder / files.JOURNAL) as add, closing(results):
            for result in self.work.follow(results, total, job.under_way):
                attempt = attempt_of(result, self.work.now())
                add(attempt)
                tried.append(attempt)
                known = "known " if attempt.known else ""
                why = f": {attempt.reason}: {attempt.message}" if attempt.reason else ""
                where = f"({attempt.seconds:g} s, {attempt.input})"
                self.write(f"{known}{attempt.status} {attempt.id} {where}{why}")


def _compared(report: NightlyReport, nights: Path, config: NightConfig) -> NightlyReport:
    """Return the same report, against the last night before it that tried anything."""
    night = report.night
    others = [other for other in files.stored_nights(nights) if other.name != night.name]
    earlier = [other for other in others if other.started <= night.started]
    before = next((other for other in reversed(earlier) if other.attempted), None)
    then = read_table(nights / before.name / files.TABLE) if before else ()
    told = [files.read_sources(nights / other.name) for other in earlier]
    roots = [mirror_of(place, config.output) for place in config.inputs]
    report = replace(
        report,
        before=before,
        sources=source_yields(report.attempts, roots, told, config.failure.source),
        changes=compare(then, report.attempts),
        allowed=config.licenses.names,
    )
    found = tuple(concerns(report, config.failure))
    night = replace(night, exit_code=exit_code(found))
    attention = tuple(concern.sentence for concern in found)
    return replace(report, night=night, attention=attention, trend=(*earlier, night))


def _row_changes(before: Sequence[Entry], now: Sequence[Entry]) -> dict[str, int]:
    """Return how many rows of the registry changed in each way, as told on the page."""
    found = diff(before, now)
    groups = ("new", "newly_passed", "newly_failed", "changed", "gone")
    counts = {name.replace("_", " "): len(getattr(found, name)) for name in groups}
    return {**counts, "same": found.same}
