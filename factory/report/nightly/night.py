"""One night: what became of each input, and the figures that this comes to."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from datetime import datetime, timedelta
from typing import Any

import msgspec

from asset_factory.sim_checks import Status

from ...intake.naming import well_formed
from ...registry.crashes import ALWAYS
from ...registry.result import Result
from ..summary import JobState
from .formats import stamp


@dataclass(frozen=True)
class NightResult:
    """What became of one input in one night: a result, and ``started``, ISO 8601 in UTC."""

    id: str
    input: str
    status: Status
    reason: str = ""
    message: str = ""
    parts: int = 0
    joints: int = 0
    hulls: int = 0
    seconds: float = 0.0
    stages: Mapping[str, float] = field(default_factory=dict)
    key: str = ""
    license: str = ""
    attempts: int = 1
    reused: tuple[str, ...] = ()
    started: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "status", Status(self.status))

    @property
    def known(self) -> bool:
        """Return whether the registry knew it already."""
        return self.attempts == 0

    @property
    def passed(self) -> bool:
        """Return whether it is registered."""
        return self.status is Status.PASSED


def attempt_of(result: Result, ended: datetime) -> NightResult:
    """Return the attempt that a build's result tells of; ``ended`` is when it came."""
    told = result.to_dict() | {"input": well_formed(result.input)}
    return attempt_from(told | {"started": stamp(ended - timedelta(seconds=result.seconds))})


def attempt_from(data: Mapping[str, Any]) -> NightResult:
    """Return an attempt from JSON data of any version. Raises ValueError where it is none."""
    return msgspec.convert(data, NightResult)


def latest(attempts: Iterable[NightResult]) -> tuple[NightResult, ...]:
    """Return the last attempt of each input, unless it repeats what an earlier one found.

    A night that goes on after an interruption asks for all its inputs once more. The registry
    answers those done before in no time; their true times are those of the earlier attempt.
    """
    kept: dict[str, NightResult] = {}
    for attempt in attempts:
        before = kept.get(attempt.input)
        if before is None or not (attempt.known and _verdict(before) == _verdict(attempt)):
            kept[attempt.input] = attempt
    return tuple(kept[name] for name in sorted(kept))


def _verdict(attempt: NightResult) -> tuple[str, str, str]:
    return attempt.id, attempt.status, attempt.key


@dataclass(frozen=True)
class Night:
    """One night in figures: the head of its summary, and a point of the trend.

    Attributes:
        name: of its folder.
        state: ``finished``, ``interrupted``, or how the budget ended it.
        started, ended: ISO 8601 in UTC.
        seconds: that it ran, all its runs together [s].
        found: inputs there were.
        passed, rejected, unjudged: how many of each verdict.
        known: of all those, known from before.
        crashed: of those unjudged, known to crash and waiting for another version of something.
        waiting: not begun.
        left_out: not begun because of their license.
        verified: entries compared with their files; ``None``: not done.
        damaged: of those, how many were not as registered.
        mended: of those damaged, how many are whole again.
        withdrawn: of those damaged, how many are registered no more.
        exit_code: what the command ended with.
    """

    name: str
    state: str = JobState.FINISHED
    started: str = ""
    ended: str = ""
    seconds: float = 0.0
    found: int = 0
    passed: int = 0
    rejected: int = 0
    unjudged: int = 0
    known: int = 0
    crashed: int = 0
    waiting: int = 0
    left_out: int = 0
    verified: int | None = None
    damaged: int = 0
    mended: int = 0
    withdrawn: int = 0
    exit_code: int = 0

    @property
    def attempted(self) -> int:
        """Return the inputs with a verdict, or without one because they could not be validated."""
        return self.passed + self.rejected + self.unjudged

    @property
    def yielded(self) -> float | None:
        """Return the share of those attempted that passed, 0 to 1; ``None`` without any."""
        return share(self.passed, self.attempted)


def share(part: float, whole: float) -> float | None:
    """Return a share, 0 to 1; ``None`` of nothing."""
    return part / whole if whole else None


def tally(attempts: Sequence[NightResult]) -> dict[str, int]:
    """Return how many attempts of each verdict, known, and known to crash: a night's arguments."""
    statuses = [attempt.status for attempt in attempts]
    counts = {str(status): statuses.count(status) for status in Status}
    crashed = sum(attempt.known and attempt.reason == ALWAYS for attempt in attempts)
    return {**counts, "known": sum(attempt.known for attempt in attempts), "crashed": crashed}


def night_to(night: Night) -> dict[str, Any]:
    """Return JSON data: its figures and its ``yield``."""
    yielded = night.yielded
    return {**asdict(night), "yield": None if yielded is None else round(yielded, 6)}


def night_from(data: Mapping[str, Any]) -> Night:
    """Return a night from JSON data of any version. Raises ValueError where it is none."""
    return msgspec.convert(data, Night)
