"""One night, in order: build, verify, compare, tidy, report."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path
from typing import Any, cast

from ...errors import AssetFactoryError, RegistryError
from ...registry import Entry
from ...registry.diff import diff
from ...registry.result import Result
from ...registry.verify import Problem
from ...report.nightly.figures import compare
from ...report.nightly.folder import (
    JOURNAL,
    LOG,
    TABLE,
    chosen_name,
    nights_of,
    publish,
    read_night,
    stored_nights,
    unfinished,
)
from ...report.nightly.formats import counted, stamp
from ...report.nightly.night import (
    INTERRUPTED,
    PASSED,
    Attempt,
    Night,
    attempt_of,
    latest,
    tally,
)
from ...report.nightly.outcome import concerns, exit_code
from ...report.nightly.report import NightlyReport
from ...report.nightly.table import read_table
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
    nights = nights_of(config.output)
    with _writable(nights):
        nights.mkdir(parents=True, exist_ok=True)
        with locked(nights) as announce:
            if fresh:
                for left in unfinished(nights):
                    close(nights / left, config)
            folder = nights / chosen_name(nights, name)
            announce(folder.name)
            folder.mkdir(exist_ok=True)
            (folder / JOURNAL).touch()
            with log(folder / LOG, now) as write:
                report = _Run(folder, config, work, write, now).report(found)
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
    tried = read_journal(folder / JOURNAL)
    attempts = latest(tried)
    started = min((attempt.started for attempt in attempts), default="")
    night = read_night(folder) or Night(
        folder.name, INTERRUPTED, started, started, found=len(attempts), **tally(attempts)
    )
    publish(folder, _compared(folder, config, night, tried))
    (folder / JOURNAL).unlink()


@dataclass(frozen=True)
class _Run:
    """One run of a night, which may have been begun by others."""

    folder: Path
    config: NightConfig
    work: Work
    write: Callable[[str], None]
    now: Callable[[], datetime]

    def report(self, found: Sequence[Path]) -> NightlyReport:
        """Do everything that is to be done with the inputs found, and tell of it."""
        began = self.now()
        earlier = read_night(self.folder)
        registered = self.work.entries()
        tried = list(read_journal(self.folder / JOURNAL))
        told = ", ".join(f"{name}: {value}" for name, value in self.work.settings.items())
        self.write(
            f"night {self.folder.name} {'goes on' if tried or earlier else 'begins'}: {told}"
        )

        inputs, left_out = sort_out(found, self.config.licenses)
        self.write(f"{counted(len(found), 'input')}, {len(left_out)} left out for their license")
        state, damage = self._do(inputs, tried)

        entries = self.work.entries()
        attempts = latest(tried)
        ended = self.now()
        seconds = (earlier.seconds if earlier else 0.0) + (ended - began).total_seconds()
        first = min([stamp(began), *(attempt.started for attempt in tried)])
        night = Night(
            self.folder.name,
            state,
            started=earlier.started if earlier else first,
            ended=stamp(ended),
            seconds=round(seconds, 3),
            found=len(found),
            waiting=max(0, len(inputs) - len(attempts)),
            left_out=len(left_out),
            verified=None if damage is None else len(entries),
            damaged=len({problem.id for problem in damage or ()}),
            **tally(attempts),
        )
        report = _compared(
            self.folder,
            self.config,
            night,
            tried,
            damage=damage or (),
            left_out=left_out,
            not_allowed=tuple(
                entry
                for entry in entries
                if entry.status == PASSED and not self.config.licenses.allow(entry.licence)
            ),
            registry=_row_changes(registered, entries),
            settings=self.work.settings,
        )
        publish(self.folder, report)
        if state != INTERRUPTED:
            (self.folder / JOURNAL).unlink()
        return report

    def _do(
        self, inputs: tuple[Path, ...], tried: list[Attempt]
    ) -> tuple[str, tuple[Problem, ...] | None]:
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
            return INTERRUPTED, damage
        except AssetFactoryError as error:
            self.write(f"cannot go on: {error}")
            raise

    def _build(self, results: Generator[Result], total: int, tried: list[Attempt]) -> None:
        # Closed: workers hear of an interruption now, not when the job is no longer referred to.
        with journal(self.folder / JOURNAL) as add, closing(results):
            for result in self.work.follow(results, total):
                attempt = attempt_of(result, self.now())
                add(attempt)
                tried.append(attempt)
                known = "known " if attempt.known else ""
                why = f": {attempt.reason}: {attempt.message}" if attempt.reason else ""
                where = f"({attempt.seconds:g} s, {attempt.input})"
                self.write(f"{known}{attempt.status} {attempt.id} {where}{why}")


def _compared(
    folder: Path, config: NightConfig, night: Night, tried: Sequence[Attempt], **more: Any
) -> NightlyReport:
    """The report of a night against the last one before it that tried anything."""
    others = [other for other in stored_nights(folder.parent) if other.name != night.name]
    earlier = [other for other in others if other.started <= night.started]
    before = next((other for other in reversed(earlier) if other.attempted), None)
    then = read_table(folder.parent / before.name / TABLE) if before else ()
    report = NightlyReport(night, before, tuple(tried), compare(then, latest(tried)), **more)
    found = tuple(concerns(night, before, report.changes, config.failure, len(report.not_allowed)))
    night = replace(night, exit_code=exit_code(found))
    return replace(
        report,
        night=night,
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
