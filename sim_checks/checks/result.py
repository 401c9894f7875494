"""What one check hands back: its findings and numbers."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, TypedDict, Unpack

from ..report import Finding, Severity


@dataclass(frozen=True)
class CheckResult:
    """The findings of one check, in a fixed order, and every number it took (JSON data only)."""

    findings: tuple[Finding, ...] = ()
    measurements: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        object.__setattr__(self, "findings", tuple(self.findings))


class Details(TypedDict, total=False):
    """What a :class:`Finding` may say besides its code, severity and message."""

    simulator: str | None
    joint: str | None
    parts: tuple[str, ...]
    value: float | None
    unit: str | None
    limit: float | None
    cause: str | None
    joints: tuple[str, ...]


def error(code: str, message: str, **details: Unpack[Details]) -> Finding:
    """Return a finding that rejects the asset."""
    return Finding(code, Severity.HARD, message, **details)


def warning(code: str, message: str, **details: Unpack[Details]) -> Finding:
    """Return a finding with which the asset may pass."""
    return Finding(code, Severity.SOFT, message, **details)
