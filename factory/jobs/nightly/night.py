"""One night in figures: the head of its summary, and a point of the trend."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, fields
from typing import Any

from .attempt import PASSED, REJECTED, UNJUDGED, Attempt

FINISHED, INTERRUPTED, OUT_OF_TIME, LIMIT_REACHED = (
    "finished",
    "interrupted",
    "out_of_time",
    "limit_reached",
)


@dataclass(frozen=True)
class Night:
    """One night in figures.

    Attributes:
        name: of its folder.
        state: ``finished``; ``out_of_time`` and ``limit_reached`` where the budget ended it;
            ``interrupted``.
        started, ended: ISO 8601 in UTC.
        seconds: that it ran, all its runs together [s].
        found: inputs there were.
        passed, rejected, unjudged: how many of each verdict.
        known: of all those, known from before.
        waiting: not begun.
        left_out: not begun because of their licence.
        verified: entries whose files were compared with what was registered; ``None``: not done.
        damaged: of those, how many are not as registered.
        exit_code: what the command ended with.
    """

    name: str
    state: str = FINISHED
    started: str = ""
    ended: str = ""
    seconds: float = 0.0
    found: int = 0
    passed: int = 0
    rejected: int = 0
    unjudged: int = 0
    known: int = 0
    waiting: int = 0
    left_out: int = 0
    verified: int | None = None
    damaged: int = 0
    exit_code: int = 0

    @property
    def attempted(self) -> int:
        """Inputs with a verdict, or without one because they could not be judged."""
        return self.passed + self.rejected + self.unjudged

    @property
    def yielded(self) -> float | None:
        """The share that passed, 0 to 1, of those attempted; ``None`` where there were none."""
        return share(self.passed, self.attempted)


def share(part: int, whole: int) -> float | None:
    """A share, 0 to 1; ``None`` of nothing."""
    return part / whole if whole else None


def tally(attempts: Sequence[Attempt]) -> dict[str, int]:
    """How many attempts of each verdict, and how many were known from before; keyword arguments of a night."""
    statuses = [attempt.status for attempt in attempts]
    counts = {status: statuses.count(status) for status in (PASSED, REJECTED, UNJUDGED)}
    return {**counts, "known": sum(attempt.known for attempt in attempts)}


def night_to(night: Night) -> dict[str, Any]:
    """JSON data: its figures and its ``yield``."""
    yielded = night.yielded
    return {**asdict(night), "yield": None if yielded is None else round(yielded, 6)}


def night_from(data: Mapping[str, Any]) -> Night:
    """A night from JSON data, perhaps of another version. Raises KeyError, TypeError where it is none."""
    told = {item.name: data[item.name] for item in fields(Night) if item.name in data}
    for name, value in told.items():
        wanted = _KINDS[name]
        if isinstance(value, bool) or not isinstance(value, wanted):
            raise TypeError(f"a night's {name} is {value!r}")
    return Night(**{"name": data["name"], **told})


_TEXTS = ("name", "state", "started", "ended")
_KINDS: dict[str, tuple[type, ...]] = {item.name: (int,) for item in fields(Night)}
_KINDS |= {**dict.fromkeys(_TEXTS, (str,)), "seconds": (int, float), "verified": (int, type(None))}
