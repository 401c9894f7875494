"""What one check hands back to the run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from ..report import Finding


@dataclass(frozen=True)
class CheckResult:
    """The findings of one check, in a fixed order, and every number it took (JSON data only)."""

    findings: tuple[Finding, ...] = ()
    measurements: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        object.__setattr__(self, "findings", tuple(self.findings))
