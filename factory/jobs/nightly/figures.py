"""What the attempts of a night come to: why inputs failed, where the time went, under which licences."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from statistics import median

from .attempt import STATUSES, Attempt


@dataclass(frozen=True)
class Reason:
    """One reason code.

    Attributes:
        code: as docs/reasons.md explains it.
        status: ``rejected`` or ``unjudged``.
        count: how many inputs.
        example: one of them.
    """

    code: str
    status: str
    count: int
    example: Attempt


@dataclass(frozen=True)
class StageTime:
    """Time spent in one stage, over what was built anew.

    Attributes:
        stage: its name.
        seconds: all together [s].
        median: of the inputs that went through it [s].
        inputs: how many those are.
        slowest: the one that took longest.
    """

    stage: str
    seconds: float
    median: float
    inputs: int
    slowest: Attempt


@dataclass(frozen=True)
class LicenceCount:
    """Inputs under one licence.

    Attributes:
        licence: as stated; empty if it is not.
        passed, rejected, unjudged: how many of each verdict.
    """

    licence: str
    passed: int
    rejected: int
    unjudged: int


def reasons(attempts: Sequence[Attempt]) -> tuple[Reason, ...]:
    """Why inputs did not pass, the most frequent first. The example is the first by input that has a sentence."""
    groups: dict[tuple[str, str], list[Attempt]] = defaultdict(list)
    for attempt in attempts:
        if not attempt.passed:
            groups[attempt.reason, attempt.status].append(attempt)
    found = [
        Reason(code, status, len(group), min(group, key=lambda a: (not a.message, a.input)))
        for (code, status), group in groups.items()
    ]
    return tuple(sorted(found, key=lambda reason: (-reason.count, reason.code, reason.status)))


def stage_times(attempts: Sequence[Attempt]) -> tuple[StageTime, ...]:
    """Where the time went, the longest stage first; what was known from before took none."""
    spent: dict[str, list[Attempt]] = defaultdict(list)
    for attempt in attempts:
        if not attempt.known:
            for stage in attempt.stages:
                spent[stage].append(attempt)
    found = []
    for stage, group in spent.items():
        times = [attempt.stages[stage] for attempt in group]
        longest = max(group, key=lambda attempt, name=stage: (attempt.stages[name], attempt.input))  # type: ignore[misc]
        found.append(StageTime(stage, sum(times), median(times), len(group), longest))
    return tuple(sorted(found, key=lambda item: (-item.seconds, item.stage)))


def slowest(attempts: Sequence[Attempt], most: int) -> tuple[Attempt, ...]:
    """The inputs that took longest, of those built anew."""
    built = [attempt for attempt in attempts if not attempt.known]
    return tuple(sorted(built, key=lambda attempt: (-attempt.seconds, attempt.input))[:most])


def licences(attempts: Sequence[Attempt]) -> tuple[LicenceCount, ...]:
    """Inputs by licence, the most frequent first."""
    counts = Counter((attempt.licence, attempt.status) for attempt in attempts)
    names = {attempt.licence for attempt in attempts}
    found = [LicenceCount(name, *(counts[name, status] for status in STATUSES)) for name in names]
    return tuple(
        sorted(
            found, key=lambda item: (-(item.passed + item.rejected + item.unjudged), item.licence)
        )
    )
