"""One night, in order: build, verify, compare, tidy, report."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path
from typing import cast

from ...errors import AssetFactoryError, RegistryError
from ...registry import Entry
from ...registry.diff import Diff, diff
from ...registry.result import Result
from ..job import Job
from .attempt import Attempt, attempt_of, latest, tries
from .changes import compare
from .folder import (
    JOURNAL,
    LOG,
    TABLE,
    chosen_name,
    nights_of,
    read_night,
    stored_nights,
    unfinished,
)
from .journal import journal, read_journal
from .lock import held
from .log import log, utc_now
from .morning import Damage, Morning
from .night import INTERRUPTED, Night, tally
from .outcome import count, exit_code, sentences
from .permitted import not_allowed, sort_out
from .publish import publish, publish_list
from .settings import NightConfig
from .table import read_table
from .words import stamp


@dataclass(frozen=True)
class Verified:
    """What a look at everything in the registry found.

    Attributes:
        entries: how many were looked at, rejected ones included.
        damage: what is wrong with some of them.
    """

    entries: int
    damage: tuple[Damage, ...] = ()


@dataclass(frozen=True)
class Works:
    """What a night calls upon.

    Attributes:
        find: all inputs.
        begin: the job over some inputs.
        verify: compares every asset's files with what was registered.
        tidy: removes what nobody needs; says what that was.
        entries: all rows of the registry.
        follow: passes results on while it shows how far it is, of how many.
        settings: how the night is run, as told on its page.
    """

    find: Callable[[], tuple[Path, ...]]
    begin: Callable[[tuple[Path, ...]], Job]
    verify: Callable[[], Verified]
    tidy: Callable[[], str]
    entries: Callable[[], tuple[Entry, ...]]
    follow: Callable[[Iterable[Result], int], Iterable[Result]]
    settings: Mapping[str, str]


def run_night(
    config: NightConfig,
    works: Works,
    *,
    name: str | None = None,
    fresh: bool = False,
    now: Callable[[], datetime] = utc_now,
) -> Morning:
    """Run a night, or go on with one that was interrupted.

    An interruption (KeyboardInterrupt) ends it early with a page of its own, and the next night
    goes on with it; so it does after the process was killed, with all that was finished.

    Args:
        config: what to do.
        works: what it is done with.
        name: of the night; by default the one that goes on, else the next number.
        fresh: begin a new one; interrupted ones stay as they are.
        now: tells the time.

    Raises:
        ConfigError: another night runs on this output, or the name cannot be.
        RegistryError: the output cannot be written any more; the next run goes on.
    """
    found, nights = works.find(), nights_of(config.output)
    with _writable(nights):
        nights.mkdir(parents=True, exist_ok=True)
        with held(nights) as tell:
            if fresh:
                for left in unfinished(nights):
                    close(nights / left, config)
            name = chosen_name(nights, name)
            tell(name)
            folder = nights / name
            folder.mkdir(exist_ok=True)
            (folder / JOURNAL).touch()
            with log(folder / LOG, now) as write:
                morning = _night(folder, config, works, found, write, now)
                write(
                    f"ends with exit code {morning.night.exit_code}: {' '.join(morning.attention) or 'all is well'}"
                )
            return morning


@contextmanager
def _writable(nights: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        why = f"{error.filename or nights}: {error.strerror or error}"
        raise RegistryError(
            f"{why}; what was finished is registered, and the next run goes on"
        ) from error


def close(folder: Path, config: NightConfig) -> None:
    """Leave an interrupted night as it is: with a page, and never gone on with."""
    done = read_journal(folder / JOURNAL)
    attempts = latest(done)
    started = min((attempt.started for attempt in attempts), default="")
    night = read_night(folder)
    if night is None:
        night = Night(
            folder.name, INTERRUPTED, started, started, found=len(attempts), **tally(attempts)
        )
    publish(folder, _morning(folder, config, night, done, Verified(0), ()))
    (folder / JOURNAL).unlink()


def _night(
    folder: Path,
    config: NightConfig,
    works: Works,
    found: tuple[Path, ...],
    write: Callable[[str], None],
    now: Callable[[], datetime],
) -> Morning:
    began, earlier, entries = now(), read_night(folder), works.entries()
    done = list(read_journal(folder / JOURNAL))
    write(
        f"night {folder.name} {'goes on' if done or earlier else 'begins'}: {_told(works.settings)}"
    )
    inputs, left = sort_out(found, config.licences)
    write(f"{count(len(found), 'input')}, {len(left)} left out for their licence")
    state, verified = _worked(folder, config, works, inputs, done, write, now)
    attempts, ended = latest(done), now()
    night = Night(
        name=folder.name,
        state=state,
        started=earlier.started
        if earlier
        else min([stamp(began), *(attempt.started for attempt in done)]),
        ended=stamp(ended),
        seconds=round((earlier.seconds if earlier else 0.0) + (ended - began).total_seconds(), 3),
        found=len(found),
        waiting=max(0, len(inputs) - len(attempts)),
        left_out=len(left),
        verified=verified.entries if verified else None,
        damaged=len({item.id for item in verified.damage}) if verified else 0,
        **tally(attempts),
    )
    kept = works.entries()
    morning = _morning(
        folder, config, night, done, verified or Verified(0), not_allowed(kept, config.licences)
    )
    morning = replace(
        morning, left_out=left, registry=_counts(diff(entries, kept)), settings=works.settings
    )
    publish(folder, morning)
    if state != INTERRUPTED:
        (folder / JOURNAL).unlink()
    publish_list(folder.parent, stored_nights(folder.parent), morning)
    return morning


def _worked(
    folder: Path,
    config: NightConfig,
    works: Works,
    inputs: tuple[Path, ...],
    done: list[Attempt],
    write: Callable[[str], None],
    now: Callable[[], datetime],
) -> tuple[str, Verified | None]:
    """Build, verify and tidy; adds to ``done``. Returns how the night ended, and what was verified."""
    job, verified = works.begin(inputs), None
    try:
        # Workers must hear of an interruption now, not when the last reference to the job is
        # dropped.
        with (
            journal(folder / JOURNAL) as book,
            closing(cast("Generator[Result, None, None]", job.run())) as results,
        ):
            for result in works.follow(results, len(inputs)):
                attempt = attempt_of(result, now())
                book.add(attempt)
                done.append(attempt)
                write(_line(attempt))
        if config.verify:
            verified = works.verify()
            write(
                f"verified {verified.entries:,} entries, found {count(len(verified.damage), 'problem')}"
            )
        if config.upkeep.enabled:
            write(f"tidied: {works.tidy()}")
        return job.state, verified
    except KeyboardInterrupt:
        write("interrupted")
        return INTERRUPTED, verified
    except AssetFactoryError as error:
        write(f"cannot go on: {error}")
        raise


def _morning(
    folder: Path,
    config: NightConfig,
    night: Night,
    done: Sequence[Attempt],
    verified: Verified,
    forbidden: tuple[Attempt, ...],
) -> Morning:
    attempts = latest(done)
    others = [other for other in stored_nights(folder.parent) if other.name != night.name]
    earlier = [other for other in others if other.started <= night.started]
    before = next((other for other in reversed(earlier) if other.attempted), None)
    changes = compare(read_table(folder.parent / before.name / TABLE) if before else (), attempts)
    night = replace(night, exit_code=exit_code(night, before, changes, config.failure))
    return Morning(
        night=night,
        before=before,
        attempts=attempts,
        tries=tries(done),
        changes=changes,
        attention=sentences(night, before, changes, config.failure, len(forbidden)),
        damage=verified.damage,
        rules=config.licences,
        not_allowed=forbidden,
        trend=(*earlier, night),
    )


def _counts(difference: Diff) -> dict[str, int]:
    """How many rows of each kind of change, as told on the page."""
    groups = ("new", "newly_passed", "newly_failed", "changed", "gone")
    return {
        **{name.replace("_", " "): len(getattr(difference, name)) for name in groups},
        "same": difference.same,
    }


def _line(attempt: Attempt) -> str:
    known = "known " if attempt.known else ""
    why = f": {attempt.reason}: {attempt.message}" if attempt.reason else ""
    return f"{known}{attempt.status} {attempt.id} ({attempt.seconds:g} s, {attempt.input}){why}"


def _told(settings: Mapping[str, str]) -> str:
    return ", ".join(f"{name}: {value}" for name, value in settings.items())
