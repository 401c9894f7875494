"""What one check hands back: its findings and numbers."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, TypedDict, Unpack

from ..description import JointLine
from ..report import Finding, Severity

Findings = Iterator[Finding]
#: Numbers of engines keep this many decimals: they differ in the last bits from machine to machine.
DECIMALS = 6


@dataclass(frozen=True)
class CheckResult:
    """The findings of one check, in a fixed order, and every number it took (JSON data only)."""

    findings: tuple[Finding, ...] = ()
    measurements: Mapping[str, Any] = field(default_factory=dict)


class Concerned(TypedDict, total=False):
    """Whom a :class:`Finding` concerns."""

    joint: str | None
    parts: tuple[str, ...]


class Measured(TypedDict, total=False):
    """The number in a :class:`Finding`, and what it was held against."""

    value: float | None
    unit: str | None
    limit: float | None


class Details(Concerned, Measured, total=False):
    """What a :class:`Finding` may say besides its code, severity and message."""

    simulator: str | None
    cause: str | None
    joints: tuple[str, ...]


def measured(value: float | None, unit: str | None = None, limit: float | None = None) -> Measured:
    """Return a number and its limit, ``None`` where they are none that JSON can hold."""
    return {"value": finite(value), "unit": unit, "limit": finite(limit)}


def rounded(value: float, unit: str, limit: float) -> Measured:
    """Return a number and its limit to so many decimals that a last bit changes no report."""
    return measured(float(round(value, DECIMALS)), unit, float(round(limit, DECIMALS)))


def in_mm(value: float, limit: float, digits: int = 4) -> Measured:
    """Return a length and its limit [m] as a report states them [mm]."""
    return measured(round(1000 * value, digits), "mm", round(1000 * limit, digits))


def about(joint: JointLine) -> Concerned:
    """Return a joint as the subject of a finding, with the links that it joins."""
    return {"joint": joint.name, "parts": (joint.parent, joint.child)}


def error(code: str, message: str, **details: Unpack[Details]) -> Finding:
    """Return a finding that rejects the asset."""
    return Finding(code, Severity.ERROR, message, **details)


def warning(code: str, message: str, **details: Unpack[Details]) -> Finding:
    """Return a finding with which the asset may pass."""
    return Finding(code, Severity.WARNING, message, **details)


def graded(grave: bool, code: str, message: str, **details: Unpack[Details]) -> Finding:
    """Return an error where it is grave, else a warning."""
    return Finding(code, Severity.ERROR if grave else Severity.WARNING, message, **details)


def note(code: str, message: str, **details: Unpack[Details]) -> Finding:
    """Return a finding that asks for no change of the file."""
    return Finding(code, Severity.NOTE, message, **details)


def not_finite(what: str, doing: str, **concerned: Unpack[Concerned]) -> Finding:
    """Return the error that an engine gave no number for where something is."""
    return error("not_finite", f"{what} went to infinity or NaN while {doing}", **concerned)


def finite(value: float | None) -> float | None:
    """Return the number, or ``None`` where it is none that JSON can hold."""
    return value if value is not None and math.isfinite(value) else None


def significant(value: float | None, digits: int = 6) -> float | None:
    """Round to so many significant digits; ``None`` where there is no number to write."""
    return None if finite(value) is None else float(f"{value:.{digits}g}")


def listed(names: Sequence[str], most: int = 4) -> str:
    """Return a few names and the number of the others."""
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return ", ".join(repr(name) for name in names[:most]) + more


def three(values: Any) -> str:
    """Return three numbers as a sentence holds them."""
    return "(" + ", ".join(f"{float(v):.4g}" for v in values) + ")"
