"""All that is known of a night: what its summary, its page and its message are made from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from functools import cached_property
from typing import Any

from ...registry import Entry
from ...registry.verify import Problem, Settled
from ..summary import JobState
from .figures import Changes, InputChange, SourceYield, licenses, reasons, slowest, stage_times
from .formats import clock_span, counted, percent, points
from .night import Night, NightResult, latest, night_to, share

SCHEMA_VERSION = 2


@dataclass(frozen=True)
class LeftOut:
    """An input that was not built: its path, and the license that its sidecar states."""

    input: str
    license: str


@dataclass(frozen=True)
class NightlyReport:
    """All that is known of a night.

    Attributes:
        night: its figures.
        before: those of the night before; ``None`` for the first one.
        tried: its attempts as they ended, those of its earlier runs included.
        changes: against the night before.
        attention: sentences to read first.
        damage: of registered assets, as it was found.
        left_out: inputs that were not built for their license.
        not_allowed: assets registered under a license that is not allowed now.
        allowed: licenses that are; empty: all of them.
        registry: how many rows this night added, removed and so on.
        settings: how it was run, as told on the page.
        trend: nights in their order, this one last.
        settled: what became of each damaged asset, by id; none where nothing was mended.
        sources: the yield by source.
    """

    night: Night
    before: Night | None = None
    tried: tuple[NightResult, ...] = ()
    changes: Changes = field(default_factory=Changes)
    attention: tuple[str, ...] = ()
    damage: tuple[Problem, ...] = ()
    left_out: tuple[LeftOut, ...] = ()
    not_allowed: tuple[Entry, ...] = ()
    allowed: tuple[str, ...] = ()
    registry: Mapping[str, int] = field(default_factory=dict)
    settings: Mapping[str, str] = field(default_factory=dict)
    trend: tuple[Night, ...] = ()
    settled: Mapping[str, Settled] = field(default_factory=dict)
    sources: tuple[SourceYield, ...] = ()

    @cached_property
    def attempts(self) -> tuple[NightResult, ...]:
        """Return what the night says of its inputs, one attempt each, by input."""
        return latest(self.tried)


def summary(report: NightlyReport) -> dict[str, Any]:
    """Return JSON data of ``summary.json``; the attempts are in the table."""
    attempts = report.attempts
    changes = report.changes
    return {
        "schema": SCHEMA_VERSION,
        "night": night_to(report.night),
        "attention": report.attention,
        "settings": report.settings,
        "reasons": [asdict(item) for item in reasons(attempts)],
        "stages": [asdict(item) for item in stage_times(attempts)],
        "slowest": [{"id": item.id, "seconds": item.seconds} for item in slowest(attempts)],
        "licenses": [asdict(item) for item in licenses(attempts)],
        "against": {
            "night": report.before.name if report.before else None,
            "shared": changes.shared,
            "yield_before": share(changes.passed_before, changes.shared),
            "yield_now": share(changes.passed_now, changes.shared),
            "fresh": len(changes.fresh),
            "gone": len(changes.gone),
            "newly_failing": [_change(item) for item in changes.failing],
            "newly_passed": [_change(item) for item in changes.passing],
        },
        "sources": [asdict(item) for item in report.sources],
        "damage": [
            {
                "id": item.id,
                "code": item.kind,
                "message": item.message,
                "became": report.settled.get(item.id),
            }
            for item in report.damage
        ],
        "left_out": [asdict(item) for item in report.left_out],
        "not_allowed": [entry.id for entry in report.not_allowed],
        "registry": report.registry,
    }


def _change(change: InputChange) -> dict[str, Any]:
    names = ("id", "input", "status", "reason", "message")
    told = {name: getattr(change.now, name) for name in names}
    return {**told, "same_content": change.same_content}


def message(report: NightlyReport) -> str:
    """Return what the night came to, in one line for a chat."""
    night = report.night
    change = points(report.before.yielded if report.before else None, night.yielded)
    figures = ", ".join(filter(None, (percent(night.yielded), change)))
    yielded = "" if night.yielded is None else f" ({figures})"
    counts = {
        "rejected": night.rejected,
        "unjudged": night.unjudged,
        "newly failing": len(report.changes.failing),
        "newly passed": len(report.changes.passing),
        "DAMAGED": night.damaged - night.mended,
        "mended": night.mended,
        "not begun": night.waiting,
    }
    told = [f"{night.passed:,} of {counted(night.attempted, 'input')} passed{yielded}"]
    told += [f"{number:,} {what}" for what, number in counts.items() if number]
    state = "" if night.state == JobState.FINISHED else f" [{night.state.replace('_', ' ')}]"
    return f"Night {night.name}{state}: {', '.join(told)}; {clock_span(night.seconds)}."
