"""What repairs and hulls left of an object: of its joints' ranges, of its visible surfaces."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from ..articulation import Articulation
from .validate import Verdict

#: Of a report's measurements.
KEPT = "kept"


def kept_of(
    hypothesis: Articulation, made: Articulation, measured: Mapping[str, Any]
) -> dict[str, float]:
    """Return the shares left of a hypothesis, made and measured as a URDF, 0 to 1, by name.

    ``range``: mean over its joints, 0 for one that was frozen or given up. ``coverage``: of the
    visible surface within 10 mm of collision geometry, mean over links; ``worst_coverage``: of the
    worst link.
    """
    ranges = {joint.name: joint.range for joint in made.movable_joints}
    shares = [
        min(1.0, ranges.get(joint.name, 0.0) / joint.range) for joint in hypothesis.movable_joints
    ] or [1.0]
    links = measured.get("lint", {}).get("links", [])
    covered = [float(link["covered"]) for link in links if "covered" in link] or [1.0]
    return {
        "range": round(sum(shares) / len(shares), 4),
        "coverage": round(sum(covered) / len(covered), 4),
        "worst_coverage": round(min(covered), 4),
    }


def with_kept(verdict: Verdict, hypothesis: Articulation, made: Articulation) -> Verdict:
    """Return the same verdict, its report telling the parts and joints left."""
    measurements = verdict.report.measurements
    kept = kept_of(hypothesis, made, measurements.get("asset.urdf", {}))
    return replace(
        verdict, report=replace(verdict.report, measurements={**measurements, KEPT: kept})
    )
