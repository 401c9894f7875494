"""Do the same joint values give the same link poses in the engine and in our own kinematics?"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from ..config import LoadingConfig
from ..description import Description, FloatArray, JointLine, sensible
from ..geometry.kinematics import find_tree
from ..report import Finding
from ..simulators.simulator import JointValues, Observation
from .result import CheckResult, error, measured, significant

#: Shares of the range at which link poses are compared; irrational steps, so that no symmetry hides
#: a sign.
POSE_SHARES = (0.0, 1.0, 0.381966, 0.763932)

#: Of the worst differences [m] and [rad].
DECIMALS = 12


def pose_samples(description: Description) -> tuple[JointValues, ...]:
    """Return joint values where every engine must agree with our kinematics: ends, uneven mixtures.

    Joints that follow others are where these take them; every joint that moves has a value.
    """
    tree = find_tree(description)
    if tree is None:
        # There is no pose to compare with.
        return ()
    return tuple(tree.completed(_sample(tree.free, share)) for share in POSE_SHARES)


def _sample(joints: tuple[JointLine, ...], share: float) -> dict[str, float]:
    mixed = 0.0 < share < 1.0
    shares = ((share + 0.618034 * i) % 1.0 if mixed else share for i in range(len(joints)))
    return {joint.name: _at(joint, at) for joint, at in zip(joints, shares, strict=True)}


def _at(joint: JointLine, share: float) -> float:
    lower = joint.lower
    upper = joint.upper
    if lower is None or upper is None or not sensible((lower, upper)):
        return share
    return lower + share * (upper - lower)


def check_agreement(
    description: Description, observation: Observation, config: LoadingConfig
) -> CheckResult:
    """Compare every link's pose to the root at every sample; the worst per link is reported.

    A sample says where every joint was put, so followers are compared where they were put, too.
    """
    tree = find_tree(description)
    if tree is None:
        return CheckResult()
    worst: dict[str, tuple[float, float]] = {}
    for sample in observation.poses:
        expected = tree.link_poses(sample.values)
        base = sample.poses.get(tree.root)
        if base is None:
            continue
        # Nothing can be told of where the links are if the base is nowhere, and so every link is.
        from_base = np.linalg.inv(base) if np.isfinite(base).all() else np.full((4, 4), np.nan)
        for name in (link.name for link in description.links if link.name in sample.poses):
            distance, angle = _difference(expected[name], from_base @ sample.poses[name])
            before = worst.get(name, (0.0, 0.0))
            worst[name] = (max(before[0], distance), max(before[1], angle))
    findings = [
        _finding(name, *off, config)
        for name, off in worst.items()
        if off[0] > config.position_m or off[1] > config.angle_rad
    ]
    measurements = {
        "pose_samples": len(observation.poses),
        "links_compared": len(worst),
        "worst_position_m": _largest(d for d, _ in worst.values()),
        "worst_angle_rad": _largest(a for _, a in worst.values()),
    }
    return CheckResult(tuple(findings), measurements)


def _largest(values: Iterable[float]) -> float | None:
    # Below that a difference is one of rounding, and another on every processor.
    return significant(round(max(values, default=0.0), DECIMALS), 3)


def _finding(name: str, distance: float, angle: float, config: LoadingConfig) -> Finding:
    told = measured(distance, "m", config.position_m)
    if math.isinf(distance):
        message = f"has NaN or infinity for the place of link {name!r}"
        return error("pose_mismatch", message, parts=(name,), **told)
    off = [(1000.0 * distance, 1000.0 * config.position_m, "mm")]
    off += [(math.degrees(angle), math.degrees(config.angle_rad), "deg")]
    off = [each for each in off if each[0] > each[1]]
    message = (
        f"puts link {name!r} up to "
        f"{' and '.join(f'{value:.4g} {unit}' for value, _, unit in off)} from where the file puts "
        f"it; at most {' and '.join(f'{most:.3g} {unit}' for _, most, unit in off)} is allowed"
    )
    return error("pose_mismatch", message, parts=(name,), **told)


def _difference(ours: FloatArray, theirs: npt.NDArray[Any]) -> tuple[float, float]:
    """Return distance [m] and angle [rad] between two poses, [4, 4]; infinite where one is NaN."""
    if not np.isfinite(theirs).all():
        return math.inf, math.pi
    distance = float(np.linalg.norm(ours[:3, 3] - theirs[:3, 3]))
    turn = ours[:3, :3].T @ theirs[:3, :3]
    # The chord of a rotation keeps its precision at small angles, where the arc cosine of the trace
    # has none.
    chord = float(np.linalg.norm(turn - np.eye(3))) / math.sqrt(8.0)
    return distance, 2.0 * math.asin(min(1.0, chord))
