"""What repairs and hulls left of an object: of its joints' ranges, of its visible surfaces."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from ..articulation import Articulation
from .validate import Verdict

#: Of a report's measurements.
KEPT = "kept"


@dataclass(frozen=True)
class Kept:
    """Shares that are left, 0 to 1.

    Attributes:
        range: mean over the joints of the hypothesis; 0 for one that was frozen or given up.
        coverage: of the visible surface within 10 mm of collision geometry, mean over links.
        worst_coverage: of the worst link.
    """

    range: float
    coverage: float
    worst_coverage: float

    def to_dict(self) -> dict[str, float]:
        """Return the shares as a report has them."""
        return {name: round(share, 4) for name, share in vars(self).items()}


def kept_of(hypothesis: Articulation, made: Articulation, measured: Mapping[str, Any]) -> Kept:
    """Return the parts and joints left of a hypothesis, made and measured as a URDF."""
    ranges = {joint.name: joint.range for joint in made.movable_joints}
    shares = [
        min(1.0, ranges.get(joint.name, 0.0) / joint.range) for joint in hypothesis.movable_joints
    ]
    links = measured.get("lint", {}).get("links", [])
    covered = [float(link["covered"]) for link in links if "covered" in link] or [1.0]
    return Kept(
        sum(shares) / len(shares) if shares else 1.0, sum(covered) / len(covered), min(covered)
    )


def with_kept(verdict: Verdict, hypothesis: Articulation, made: Articulation) -> Verdict:
    """Return the same verdict, its report telling the parts and joints left."""
    measurements = verdict.report.measurements
    kept = kept_of(hypothesis, made, measurements.get("asset.urdf", {}))
    told = {**measurements, KEPT: kept.to_dict()}
    return replace(verdict, report=replace(verdict.report, measurements=told))
