"""Numbers as people read them."""

from datetime import UTC, datetime

MINUS = "−"


def counted(number: int, noun: str) -> str:
    """Return ``1 asset``, ``1,200 assets``."""
    return f"{number:,} {noun}{'' if number == 1 else 's'}"


def percent(value: float | None) -> str:
    """Return ``87.3 %``, a dash for none; 100 % only for all, 0 % only for nothing."""
    if value is None:
        return "–"
    if 0.9995 <= value < 1.0:
        return "over 99.9 %"
    if 0.0 < value < 0.0005:
        return "under 0.1 %"
    return f"{100 * value:.0f} %" if value in (0.0, 1.0) else f"{100 * value:.1f} %"


def points(before: float | None, now: float | None) -> str:
    """Return ``+1.2 points`` of a per cent; empty where there is nothing to compare."""
    if before is None or now is None:
        return ""
    change = round(100 * (now - before), 1)
    if change == 0.0:
        return "unchanged"
    return f"{'+' if change > 0 else MINUS}{abs(change):.1f} points"


def span(seconds: float) -> str:
    """Return ``0.4 s``, ``41 s``, ``12 min 05 s``, ``4 h 12 min``."""
    return f"{seconds:.1f} s" if seconds < 10.0 else clock_span(seconds)


def clock_span(seconds: float) -> str:
    """Return ``4 s``, ``41 s``, ``12 min 05 s``, ``4 h 12 min``."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60:02d} s"
    minutes = round(seconds / 60)
    return f"{minutes // 60:,} h {minutes % 60:02d} min"


def stamp(moment: datetime) -> str:
    """Return a time as ISO 8601 in UTC, to the second."""
    return moment.astimezone(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")


def readable(stamped: str) -> str:
    """Return ``21 Nov 2026, 01:00 UTC`` of such a stamp; another text as it is."""
    try:
        moment = datetime.fromisoformat(stamped)
    except ValueError:
        return stamped
    return f"{moment.day} {moment.strftime('%b %Y, %H:%M')} UTC"


def figure(value: object) -> str:
    """Return ``1,200``, a dash for none, texts as they are."""
    return f"{value:,}" if isinstance(value, int) else "–" if value is None else str(value)
