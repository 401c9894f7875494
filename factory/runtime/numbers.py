"""Numbers as they are written: the same for the same value on every machine."""

from __future__ import annotations

#: Positions, angles, limits: a nanometre is below every simulator's single precision.
DECIMALS = 9


def rounded(value: float, decimals: int = DECIMALS) -> float:
    """``value`` rounded, without a negative zero."""
    return round(float(value), decimals) + 0.0


def magnitude(value: float) -> float:
    """``value`` to twelve significant digits: masses and inertias have no smallest size."""
    return float(f"{float(value):.12g}") + 0.0
