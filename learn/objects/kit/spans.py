"""Spans along an axis, and what they are cut into.

Lengths are in metres. A span is the lower and the upper end along one axis. Where something lies in
a plane across an axis, its two coordinates are those of the other two axes in the order x, y, z.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

Span = tuple[float, float]
Flat = tuple[float, float]
#: ``(radius, height)`` of each ring of a turned form.
Profile = list[tuple[float, float]]

#: Between parts that move past each other [m].
PLAY = 0.0008


def about(half: float, middle: float = 0.0) -> Span:
    """Return the span that reaches ``half`` to both sides of ``middle``."""
    return (middle - half, middle + half)


def span(start: float, length: float) -> Span:
    """Return the span from ``start`` on by ``length``, which may be negative."""
    return (start, start + length) if length >= 0.0 else (start + length, start)


def within(outer: Span, margin: float, other: float | None = None) -> Span:
    """Return a span less ``margin`` at its lower end and ``other``, or the same, above."""
    return (outer[0] + margin, outer[1] - (margin if other is None else other))


def ends(of: Span, length: float) -> tuple[Span, Span]:
    """Return the spans of this length at the lower and at the upper end of another, inside it."""
    return span(of[0], length), span(of[1], -length)


def upto(*lengths: float) -> tuple[Span, ...]:
    """Return the span from 0 for each length."""
    return tuple((0.0, length) for length in lengths)


def centred(*halves: float) -> tuple[Span, ...]:
    """Return the span about 0 for each half length."""
    return tuple((-half, half) for half in halves)


def mid(of: Span) -> float:
    """Return the middle of a span."""
    return (of[0] + of[1]) / 2


def size(of: Span) -> float:
    """Return the length of a span."""
    return of[1] - of[0]


def shares(of: Span, count: int) -> list[Span]:
    """Return a span cut into ``count`` equal ones."""
    return list(pairwise(np.linspace(*of, count + 1).tolist()))


def between(of: Span, count: int) -> list[float]:
    """Return ``count`` places that cut a span evenly, its ends not among them."""
    step = size(of) / (count + 1)
    return [of[0] + step * (i + 1) for i in range(count)]
