"""What a repair goes by: a verdict's findings and figures, and what the object can do without."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from asset_factory.sim_checks import Finding
from asset_factory.sim_checks.measurements import MeasuredContact, MeasuredJoint, penetrations

from ...asset import Asset
from ...config import RepairConfig
from ...manufacture.plan import Spare
from ...manufacture.repair import Pair, Repair, RepairKind
from ..validate import Verdict


@dataclass(frozen=True)
class RepairEvidence:
    """What a repair knows of the round just validated.

    Attributes:
        verdict: of the round.
        config: how far repairs may go.
        spare: what the object is still worth having without.
        asset: that was validated; ``None`` where only its verdict is known.
    """

    verdict: Verdict
    config: RepairConfig
    spare: Spare
    asset: Asset | None = None

    @property
    def errors(self) -> tuple[Finding, ...]:
        """Return the findings that reject."""
        return self.verdict.report.errors

    @property
    def codes(self) -> frozenset[str]:
        """Return the codes of the findings that reject."""
        return frozenset(finding.code for finding in self.errors)

    def found(self, code: str) -> Iterator[Finding]:
        """Yield the findings of one code, errors and warnings."""
        return (each for each in self.verdict.report.findings if each.code == code)

    def contacts(self) -> Iterator[MeasuredContact]:
        """Yield every two parts that come near, at rest and along the joints."""
        for measured in penetrations(self.verdict.report.measurements):
            yield from measured.contacts

    def joints(self) -> Iterator[MeasuredJoint]:
        """Yield every joint over its range."""
        for measured in penetrations(self.verdict.report.measurements):
            yield from measured.joints


def ordered(one: str, other: str) -> Pair:
    """Return two parts, in a fixed order."""
    return (min(one, other), max(one, other))


def record_change(kind: RepairKind, joint: str, before: float, after: float, unit: str) -> Repair:
    """Return the repair that changed one number of one joint."""
    return Repair(kind, joints=(joint,), before=before, after=after, unit=unit)
