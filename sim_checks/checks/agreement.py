"""Do the same joint values give the same link poses in the engine and in our own kinematics?"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from ..config import LoadingConfig
from ..description import Description, FloatArray
from ..kinematics import NotATree, build_tree
from ..report import Finding, Severity
from ..simulators.simulator import Observation
from .result import CheckResult


def check_agreement(
    description: Description, simulator: str, observation: Observation, config: LoadingConfig
) -> CheckResult:
    """Compare every link's pose relative to the root at every sample; the worst of each link is reported."""
    try:
        tree = build_tree(description)
    except NotATree:
        # The lint says so; there is no pose to compare with.
        return CheckResult()
    worst: dict[str, tuple[float, float]] = {}
    for sample in observation.poses:
        expected = tree.link_poses(sample.values)
        base = sample.poses.get(tree.root)
        if base is None:
            continue
        common = [link.name for link in description.links if link.name in expected and link.name in sample.poses]
        for name in common:
            distance, angle = _difference(expected[name], np.linalg.inv(base) @ sample.poses[name])
            before = worst.get(name, (0.0, 0.0))
            worst[name] = (max(before[0], distance), max(before[1], angle))
    findings = [
        _finding(name, distance, angle, simulator, config)
        for name, (distance, angle) in worst.items()
        if distance > config.position_m or angle > config.angle_rad
    ]
    measurements = {
        "pose_samples": len(observation.poses),
        "worst_position_m": max((d for d, _ in worst.values()), default=0.0),
        "worst_angle_rad": max((a for _, a in worst.values()), default=0.0),
    }
    return CheckResult(tuple(findings), measurements)


def _finding(name: str, distance: float, angle: float, simulator: str, config: LoadingConfig) -> Finding:
    message = (
        f"{simulator} puts link {name!r} up to {1000 * distance:.4g} mm and {math.degrees(angle):.4g} deg "
        "from where the file's own kinematics put it"
    )
    return Finding("pose_mismatch", Severity.HARD, message, simulator, None, (name,), distance, "m", config.position_m)


def _difference(ours: FloatArray, theirs: npt.NDArray[Any]) -> tuple[float, float]:
    """Distance [m] and angle [rad] between two poses, shape [4, 4] each."""
    distance = float(np.linalg.norm(ours[:3, 3] - theirs[:3, 3]))
    turn = ours[:3, :3].T @ theirs[:3, :3]
    # The chord of a rotation keeps its precision at small angles, where the arc cosine of the trace has none.
    chord = float(np.linalg.norm(turn - np.eye(3))) / math.sqrt(8.0)
    return distance, 2.0 * math.asin(min(1.0, chord))
