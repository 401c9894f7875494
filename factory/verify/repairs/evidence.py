"""What a repair goes by: a verdict's findings and figures, and what the object can do without."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

from asset_factory.sim_checks import Finding
from asset_factory.sim_checks.measurements import MeasuredJoint, MeasuredPenetration, penetrations

from ...articulation import Joint
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
        asset: that was validated.
    """

    verdict: Verdict
    config: RepairConfig
    spare: Spare
    asset: Asset

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

    def wrong_parts(self, code: str) -> frozenset[str]:
        """Return the parts that errors of one code are about."""
        return frozenset(part for each in self.errors if each.code == code for part in each.parts)

    @cached_property
    def measured(self) -> tuple[MeasuredPenetration, ...]:
        """Return how deep parts get into each other, by file."""
        return penetrations(self.verdict.report.measurements)

    def jammed(self) -> dict[str, tuple[MeasuredJoint, float]]:
        """Return the joints that never reach their range, by name, and how far they go."""
        return {
            joint.joint: (joint, joint.clear_until)
            for measured in self.measured
            for joint in measured.joints
            if joint.clear_until is not None
        }

    def blocked(self) -> dict[str, tuple[MeasuredJoint, float]]:
        """Return those, and joints that another one stops as soon as it is a little open."""
        told = {finding.joints for finding in self.found("joint_obstructed")}
        found = self.jammed()
        for measured in self.measured:
            joints = {joint.joint: joint for joint in measured.joints}
            for near in measured.neighbours:
                if near.free_until is not None and (near.joint, near.open) in told:
                    _, end = found.get(near.joint, (None, near.free_until))
                    found[near.joint] = joints[near.joint], min(end, near.free_until)
        return found


def ordered(one: str, other: str) -> Pair:
    """Return two parts, in a fixed order."""
    return (min(one, other), max(one, other))


def record_change(
    kind: RepairKind, joint: Joint, before: float, after: float, unit: str = ""
) -> Repair:
    """Return the repair that changed one number of one joint, by default in the joint's unit."""
    return Repair(kind, joints=(joint.name,), before=before, after=after, unit=unit or joint.unit)
