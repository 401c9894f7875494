"""Refusing what is too large before any memory is taken for it."""

from __future__ import annotations

from ..errors import InputRejected


def require_at_most(what: str, value: int, limit: int, unit: str) -> None:
    """Reject with ``too_large`` if ``value`` exceeds ``limit``.

    Raises:
        InputRejected: code ``too_large``, with both numbers.
    """
    if value > limit:
        raise InputRejected(
            "too_large",
            f"{what}: {value:,} {unit}, the limit is {limit:,}; simplify it or raise the limit",
            value=float(value),
            unit=unit,
            limit=float(limit),
        )


def unreadable(what: str, why: str) -> InputRejected:
    """A rejection for a file that breaks its own format; ``why`` is shortened to one line."""
    words = " ".join(why.split()) or "no reason given"
    return InputRejected("unreadable", f"{what}: {words[:240]}")
