"""One input of one night."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, fields
from datetime import datetime, timedelta
from typing import Any

from ...intake.naming import well_formed
from ...registry.result import Result
from .words import stamp

PASSED, REJECTED, UNJUDGED = "passed", "rejected", "unjudged"
STATUSES = (PASSED, REJECTED, UNJUDGED)
#: Reason of a try that was followed by another.
DIED = "tried_again"
DIED_MESSAGE = "its process crashed, hung or ran out of memory, and the input was tried again"


@dataclass(frozen=True)
class Attempt:
    """What became of one input in one night.

    Attributes:
        id: of the registry entry.
        input: path of the file.
        status: ``passed``, ``rejected`` or ``unjudged``.
        reason: code of the first hard finding; empty if it passed.
        message: that finding's sentence; empty if it passed.
        seconds: wall-clock time [s].
        attempts: how often it was begun; 0 if it was known from before, more than 1 after a crash.
        reused: stages that were answered from the cache.
        parts, joints, hulls: how many parts, movable joints and convex pieces.
        licence: of what it was made from; empty if unknown.
        key: what it was made from, as the registry keys it; empty if unknown.
        started: when, ISO 8601 in UTC.
        stages: wall-clock time by stage [s].
    """

    id: str
    input: str
    status: str
    reason: str = ""
    message: str = ""
    seconds: float = 0.0
    attempts: int = 1
    reused: tuple[str, ...] = ()
    parts: int = 0
    joints: int = 0
    hulls: int = 0
    licence: str = ""
    key: str = ""
    started: str = ""
    stages: Mapping[str, float] = field(default_factory=dict)

    @property
    def passed(self) -> bool:
        """Whether it is registered."""
        return self.status == PASSED

    @property
    def known(self) -> bool:
        """Whether the registry knew it already: same input, settings, stages and libraries."""
        return self.attempts == 0


#: Columns of the table before those of the stages.
COLUMNS = tuple(item.name for item in fields(Attempt) if item.name != "stages")


def attempt_from(data: Mapping[str, Any]) -> Attempt:
    """An attempt from JSON data; what this version does not know is passed over. Raises KeyError, TypeError."""
    known = {name: data[name] for name in (*COLUMNS, "stages") if name in data}
    return Attempt(**{**known, "reused": tuple(data.get("reused") or ())})


def attempt_of(result: Result, ended: datetime) -> Attempt:
    """The attempt that a result tells of.

    Args:
        result: as a build gives it.
        ended: when it came.
    """
    told = {**result.to_dict(), "licence": result.entry.license}
    same = {name: told[name] for name in (*COLUMNS, "stages") if name != "started"}
    same["input"] = well_formed(result.input)
    same["reused"] = tuple(same["reused"])
    return Attempt(**same, started=stamp(ended - timedelta(seconds=result.seconds)))


@dataclass(frozen=True)
class Try:
    """One row of a night's table.

    Attributes:
        attempt: what came of it, and all that is known of the input.
        number: which of them it was, from 1; 0: it was known from before, and none was made.
        last: whether it is what the night says of the input.
    """

    attempt: Attempt
    number: int
    last: bool = True


def tries(attempts: Iterable[Attempt]) -> tuple[Try, ...]:
    """Every try of a night, by input: those that died too, and those of before it was interrupted.

    Args:
        attempts: in the order in which they ended.
    """
    attempts = list(attempts)
    final = {id(attempt) for attempt in latest(attempts)}
    found = []
    for attempt in sorted(attempts, key=lambda item: item.input):
        counts = id(attempt) in final
        found += [Try(_died(attempt), number, last=False) for number in range(1, attempt.attempts)]
        if counts or not attempt.known:
            found.append(Try(attempt, attempt.attempts, counts))
    return tuple(found)


def _died(attempt: Attempt) -> Attempt:
    return Attempt(
        attempt.id, attempt.input, UNJUDGED, DIED, DIED_MESSAGE, float("nan"), attempt.attempts
    )


def latest(attempts: Iterable[Attempt]) -> tuple[Attempt, ...]:
    """One attempt per input, by input: the last, unless it only says again what an earlier one found out.

    A night that goes on after an interruption asks for all its inputs once more; those done before
    are answered from the registry in no time, and their true times are those of the earlier row.
    """
    kept: dict[str, Attempt] = {}
    for attempt in attempts:
        before = kept.get(attempt.input)
        if before is None or not (attempt.known and _alike(before, attempt)):
            kept[attempt.input] = attempt
    return tuple(kept[name] for name in sorted(kept))


def _alike(before: Attempt, now: Attempt) -> bool:
    return (before.id, before.status, before.key) == (now.id, now.status, now.key)
