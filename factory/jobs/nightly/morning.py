"""All that is known the morning after: what the summary, the page and the message are made from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from .attempt import Attempt, Try
from .changes import Change, Changes
from .figures import licences, reasons, slowest, stage_times
from .night import Night, night_to, share
from .permitted import LeftOut
from .settings import Licences

SCHEMA_VERSION = 1
SLOWEST = 20


@dataclass(frozen=True)
class Damage:
    """What is wrong with a registered asset.

    Attributes:
        id: of the registry entry.
        code: kind of damage.
        message: what, where, and what would mend it.
    """

    id: str
    code: str
    message: str


@dataclass(frozen=True)
class Morning:
    """All that is known the morning after.

    Attributes:
        night: its figures.
        before: those of the night before; ``None`` for the first one.
        attempts: one per input, by input.
        changes: against the night before.
        attention: sentences to read first.
        damage: of registered assets.
        left_out: inputs that were not built.
        rules: which licences are allowed.
        registry: rows added, removed and so on by this night.
        settings: how it was run, as told on the page.
        trend: nights in their order, this one last.
        tries: every one of the night, for its table.
        not_allowed: assets from before, registered under a licence that is not allowed now.
    """

    night: Night
    before: Night | None = None
    attempts: tuple[Attempt, ...] = ()
    changes: Changes = field(default_factory=Changes)
    attention: tuple[str, ...] = ()
    damage: tuple[Damage, ...] = ()
    left_out: tuple[LeftOut, ...] = ()
    rules: Licences = field(default_factory=Licences)
    registry: Mapping[str, int] = field(default_factory=dict)
    settings: Mapping[str, str] = field(default_factory=dict)
    trend: tuple[Night, ...] = ()
    tries: tuple[Try, ...] = ()
    not_allowed: tuple[Attempt, ...] = ()


def summary_data(morning: Morning) -> dict[str, Any]:
    """JSON data of ``summary.json``. The rows themselves are in the table."""
    changes = morning.changes
    return {
        "schema": SCHEMA_VERSION,
        "night": night_to(morning.night),
        "attention": list(morning.attention),
        "settings": dict(morning.settings),
        "reasons": [
            {
                "code": r.code,
                "status": r.status,
                "count": r.count,
                "example": r.example.id,
                "message": r.example.message,
            }
            for r in reasons(morning.attempts)
        ],
        "stages": [
            {
                "stage": s.stage,
                "seconds": round(s.seconds, 3),
                "median": round(s.median, 3),
                "inputs": s.inputs,
            }
            for s in stage_times(morning.attempts)
        ],
        "slowest": [
            {"id": a.id, "seconds": round(a.seconds, 3)} for a in slowest(morning.attempts, SLOWEST)
        ],
        "licences": [asdict(item) for item in licences(morning.attempts)],
        "against": {
            "night": morning.before.name if morning.before else None,
            "shared": changes.shared,
            "yield_before": share(changes.passed_before, changes.shared),
            "yield_now": share(changes.passed_now, changes.shared),
            "fresh": len(changes.fresh),
            "gone": len(changes.gone),
            "newly_failing": [_change(change) for change in changes.failing],
            "newly_passed": [_change(change) for change in changes.passing],
        },
        "damage": [asdict(item) for item in morning.damage],
        "left_out": [asdict(item) for item in morning.left_out],
        "not_allowed": [attempt.id for attempt in morning.not_allowed],
        "registry": dict(morning.registry),
    }


def _change(change: Change) -> dict[str, Any]:
    return {
        "id": change.now.id,
        "input": change.now.input,
        "same_content": change.same_content,
        "status": change.now.status,
        "reason": change.now.reason,
        "message": change.now.message,
    }
