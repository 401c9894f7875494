"""One line for a chat."""

from __future__ import annotations

from .morning import Morning
from .outcome import count
from .words import clock_span, percent, points


def message(morning: Morning) -> str:
    """What the night came to, in one line."""
    night, changes = morning.night, morning.changes
    parts = [f"{night.passed:,} of {count(night.attempted, 'input')} passed"]
    if night.yielded is not None:
        change = points(morning.before.yielded if morning.before else None, night.yielded)
        parts[0] += f" ({percent(night.yielded)}{', ' + change if change else ''})"
    parts += [f"{night.rejected:,} rejected"] if night.rejected else []
    parts += [f"{night.unjudged:,} unjudged"] if night.unjudged else []
    parts += [f"{len(changes.failing):,} newly failing"] if changes.failing else []
    parts += [f"{len(changes.passing):,} newly passed"] if changes.passing else []
    parts += [f"{night.damaged:,} DAMAGED"] if night.damaged else []
    parts += [f"{night.waiting:,} not begun"] if night.waiting else []
    state = "" if night.state == "finished" else f" [{night.state.replace('_', ' ')}]"
    return f"Night {night.name}{state}: {', '.join(parts)}; {clock_span(night.seconds)}."
