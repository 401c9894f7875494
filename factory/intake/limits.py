"""Refusing files that are too large before any memory is taken for them."""

from __future__ import annotations

import numpy as np

from ..errors import InputRejected
from ..mesh import FloatArray

#: Smallest extent and farthest coordinate of anything that could be an object [m].
SENSIBLE_SIZE = (1e-6, 1e6)


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


def require_sensible_size(what: str, bounds: FloatArray) -> None:
    """Reject with ``absurd_size`` what a wrong scale made too small or too large to compute with.

    Args:
        what: opens the sentence.
        bounds: lower and upper corner [m], shape [2, 3]; may hold infinity or NaN.

    Raises:
        InputRejected: code ``absurd_size``, with the number.
    """
    least, most = SENSIBLE_SIZE
    extent = float(np.ptp(bounds, axis=0).max())
    reach = float(np.abs(bounds).max())
    # NaN compares as false.
    if not (least <= extent and reach <= most):
        value, limit = (extent, least) if extent < least else (reach, most)
        raise InputRejected(
            "absurd_size",
            f"{what}: would measure {extent:.3g} m and reach {reach:.3g} m from its origin, "
            f"want {least:g} to {most:g} m; check its scale, height and units",
            value=value,
            unit="m",
            limit=limit,
        )


def unreadable(what: str, why: str) -> InputRejected:
    """Return the rejection of a file that breaks its format; ``why`` is cut to one line."""
    words = " ".join(why.split()) or "no reason given"
    return InputRejected("unreadable", f"{what}: {words[:240]}")
