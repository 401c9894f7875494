"""One night, in order: build, verify, compare, tidy, report."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path
from typing import cast

from asset_factory.sim_checks import Status

from ...errors import AssetFactoryError, RegistryError
from ...registry import Entry
from ...registry.diff import diff
from ...registry.result import Result
from ...registry.verify import Problem
from ...report.nightly import files
from ...report.nightly.figures import compare
from ...report.nightly.formats import counted, stamp
from ...report.nightly.night import Night, NightResult, attempt_of, latest, tally
from ...report.nightly.outcome import concerns, exit_code
from ...report.nightly.report import NightlyReport
from ...report.nightly.table import read_table
from ...report.summary import JobState
from .journal import journal, log, read_journal, utc_now
from .licenses import sort_out
from .lock import locked
from .settings import NightConfig
from .work import Work


def run_night(
    config: NightConfig,
    work: Work,
    *,
    name: str | None = None,
    fresh: bool = False,
    now: Callable[[], datetime] = utc_now,
) -> NightlyReport:
    """Run a night, or go on with one that was interrupted.

    An interruption (KeyboardInterrupt) ends it early with a page of its own, and the next run goes
    on with it; so it does after the process was killed, with all that was finished.

    Args:
        config: what to do.
        work: what it is done with.
        name: of the night; by default the one that goes on, else the next number.
        fresh: begin a new one; interrupted ones stay as they are.
        now: tells the time.

    Raises:
        ConfigError: another night runs on this output, or the name cannot be.
        RegistryError: the output cannot be written any more; the next run goes on.
    """
    found = work.find()
    nights = files.nights_of(config.output)
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
            with log(folder / files.LOG, now) as write:
                report = _NightRun(folder, config, work, write, now).report(found)
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


@dataclass(frozen=True)
class _NightRun:
    """One run of a night; earlier ones may have been interrupted."""

    folder: Path
    config: NightConfig
    work: Work
    write: Callable[[str], None]
    now: Callable[[], datetime]

    def report(self, found: Sequence[Path]) -> NightlyReport:
        """Build, verify and tidy, compare with the night before, and publish."""
        began = self.now()
        earlier = files.read_night(self.folder)
        rows = self.work.entries()
        tried = list(read_journal(self.folder / files.JOURNAL))
        told = ", ".join(f"{name}: {value}" for name, value in self.work.settings.items())
        begins = "goes on" if tried or earlier else "begins"
        self.write(f"night {self.folder.name} {begins}: {told}")

        inputs, left_out = sort_out(found, self.config.licenses)
        self.write(f"{counted(len(found), 'input')}, {len(left_out)} left out for their license")
        state, damage = self._do(inputs, tried)

        kept = self.work.entries()
        attempts = latest(tried)
        first = min([stamp(began), *(attempt.started for attempt in tried)])
        ended = self.now()
        seconds = (ended - began).total_seconds() + (earlier.seconds if earlier else 0.0)
        night = Night(
            self.folder.name,
            state,
            started=earlier.started if earlier else first,
            ended=stamp(ended),
            seconds=round(seconds, 3),
            found=len(found),
            waiting=max(0, len(inputs) - len(attempts)),
            left_out=len(left_out),
            verified=None if damage is None else len(kept),
            damaged=len({problem.id for problem in damage or ()}),
            **tally(attempts),
        )
        passed = [entry for entry in kept if entry.status is Status.PASSED]
        report = NightlyReport(
            night,
            tried=tuple(tried),
            damage=damage or (),
            left_out=left_out,
            not_allowed=tuple(e for e in passed if not self.config.licenses.allow(e.license)),
            registry=_row_changes(rows, kept),
            settings=self.work.settings,
        )
        report = _compared(report, self.folder.parent, self.config)
        files.publish(self.folder, report)
        if state != JobState.INTERRUPTED:
            (self.folder / files.JOURNAL).unlink()
        return report

    def _do(
        self, inputs: tuple[Path, ...], tried: list[NightResult]
    ) -> tuple[JobState, tuple[Problem, ...] | None]:
        """Build, verify and tidy; adds to ``tried``. Returns the state, and damage if verified."""
        job = self.work.job(inputs)
        damage = None
        try:
            self._build(cast("Generator[Result]", job.run()), len(inputs), tried)
            if self.config.verify:
                damage = self.work.verify()
                self.write(f"verified, found {counted(len(damage), 'problem')}")
            if self.config.upkeep.enabled:
                self.write(f"tidied: {self.work.tidy()}")
            return job.state, damage
        except KeyboardInterrupt:
            self.write("interrupted")
            return JobState.INTERRUPTED, damage
        except AssetFactoryError as error:
            self.write(f"cannot go on: {error}")
            raise

    def _build(self, results: Generator[Result], total: int, tried: list[NightResult]) -> None:
        # Closed: workers hear of an interruption now, not when the job is no longer referred to.
        with journal(self.folder / files.JOURNAL) as add, closing(results):
            for result in self.work.follow(results, total):
                attempt = attempt_of(result, self.now())
                add(attempt)
                tried.append(attempt)
                known = "known " if attempt.known else ""
                why = f": {attempt.reason}: {attempt.message}" if attempt.reason else ""
                where = f"({attempt.seconds:g} s, {attempt.input})"
                self.write(f"{known}{attempt.status} {attempt.id} {where}{why}")


def _compared(report: NightlyReport, nights: Path, config: NightConfig) -> NightlyReport:
    """The same report, against the last night before it that tried anything."""
    night = report.night
    others = [other for other in files.stored_nights(nights) if other.name != night.name]
    earlier = [other for other in others if other.started <= night.started]
    before = next((other for other in reversed(earlier) if other.attempted), None)
    then = read_table(nights / before.name / files.TABLE) if before else ()
    changes = compare(then, report.attempts)
    found = tuple(concerns(night, before, changes, config.failure, len(report.not_allowed)))
    night = replace(night, exit_code=exit_code(found))
    return replace(
        report,
        night=night,
        before=before,
        changes=changes,
        attention=tuple(concern.sentence for concern in found),
        allowed=config.licenses.names,
        trend=(*earlier, night),
    )


def _row_changes(before: Sequence[Entry], now: Sequence[Entry]) -> dict[str, int]:
    """How many rows of the registry changed in each way, as told on the page."""
    found = diff(before, now)
    groups = ("new", "newly_passed", "newly_failed", "changed", "gone")
    counts = {name.replace("_", " "): len(getattr(found, name)) for name in groups}
    return {**counts, "same": found.same}
