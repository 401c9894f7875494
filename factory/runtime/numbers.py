"""Numbers as they are written: the same for the same value on every machine."""

#: Positions, angles, limits: a nanometre is below every simulator's single precision.
DECIMALS = 9
#: Significant digits of masses and inertias: two more than single precision holds, and four fewer
#: than what processors that round sums differently were measured to agree in.
DIGITS = 9


def rounded(value: float, decimals: int = DECIMALS) -> float:
    """Return ``value`` rounded, without a negative zero."""
    return round(float(value), decimals) + 0.0


def magnitude(value: float) -> float:
    """Return ``value`` to :data:`DIGITS` significant digits: a mass has no smallest size."""
    return float(f"{float(value):.{DIGITS}g}") + 0.0
