"""What repairs and hulls left of an object: of its joints' ranges, of its visible surfaces."""

from __future__ import annotations

from dataclasses import replace

from ..articulation import Articulation
from .validate import Verdict

#: Of a report's measurements.
KEPT = "kept"


def with_kept(verdict: Verdict, hypothesis: Articulation, made: Articulation) -> Verdict:
    """Return the same verdict, its report telling the shares left of a hypothesis, 0 to 1, by name.

    ``range``: mean over its joints, 0 for one that was frozen or given up. ``coverage``: of the
    visible surface within 10 mm of collision geometry, mean over links; ``worst_coverage``: of the
    worst link.
    """
    measurements = verdict.report.measurements
    ranges = {joint.name: joint.range for joint in made.movable_joints}
    shares = [
        min(1.0, ranges.get(joint.name, 0.0) / joint.range) for joint in hypothesis.movable_joints
    ] or [1.0]
    links = measurements.get("asset.urdf", {}).get("lint", {}).get("links", [])
    covered = [float(link["covered"]) for link in links if "covered" in link] or [1.0]
    kept = {
        "range": round(sum(shares) / len(shares), 4),
        "coverage": round(sum(covered) / len(covered), 4),
        "worst_coverage": round(min(covered), 4),
    }
    report = replace(verdict.report, measurements={**measurements, KEPT: kept})
    return replace(verdict, report=report)
