"""What one check hands back: its findings and numbers."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, TypedDict, Unpack

from ..description import JointLine
from ..report import Finding, Severity

#: Numbers of engines keep this many decimals: they differ in the last bits from machine to machine.
DECIMALS = 6


@dataclass(frozen=True)
class CheckResult:
    """The findings of one check, in a fixed order, and every number it took (JSON data only)."""

    findings: tuple[Finding, ...] = ()
    measurements: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        object.__setattr__(self, "findings", tuple(self.findings))


class Concerned(TypedDict, total=False):
    """Whom a :class:`Finding` concerns, and which engine found it."""

    simulator: str | None
    joint: str | None
    parts: tuple[str, ...]


class Details(Concerned, total=False):
    """What a :class:`Finding` may say besides its code, severity and message."""

    value: float | None
    unit: str | None
    limit: float | None
    cause: str | None
    joints: tuple[str, ...]


def about(joint: JointLine, simulator: str | None = None) -> Concerned:
    """Return a joint as the subject of a finding, with the links that it joins."""
    return {"simulator": simulator, "joint": joint.name, "parts": (joint.parent, joint.child)}


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


def finite(value: float) -> float | None:
    """Return the number, or ``None`` where it is none that JSON can hold."""
    return value if math.isfinite(value) else None


def significant(value: float | None, digits: int = 6) -> float | None:
    """Round to so many significant digits; ``None`` where there is no number to write."""
    return None if value is None or not math.isfinite(value) else float(f"{value:.{digits}g}")


def listed(names: Sequence[str], most: int = 4) -> str:
    """Return a few names and the number of the others."""
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return ", ".join(repr(name) for name in names[:most]) + more


def three(values: Any) -> str:
    """Return three numbers as a sentence holds them."""
    return "(" + ", ".join(f"{float(v):.4g}" for v in values) + ")"
