"""The metrics as the published code computes them, for comparison with published numbers only.

Past the first state, boxes of parts that move are those at rest, moved as solids: their overlap is
estimated from random points, the box around both is taken at rest, a lower limit other than 0 is
forgotten, a part that turns and slides only turns, and on the way from the true parts to the
predicted ones the two lists of motions are exchanged. A hinge on the wrong side scores in full.
"""

from __future__ import annotations

import numpy as np

from asset_factory.factory.mesh import FloatArray

from ..score import Score
from .boxes import box_of, giou, volume
from .cloud import ScoredCloud
from .matched import Matching, matched
from .state import PENALTIES, compared

STATES = (0.0, 0.25, 0.5, 0.75, 1.0)
#: Random points per box.
SAMPLES = 2048


def release(true: ScoredCloud, predicted: ScoredCloud, seed: int = 0) -> Score:
    """Compare a prediction with the truth at rest and over five states.

    ``seed`` is of the points that estimate overlaps.

    Returns:
        Names as in :func:`.state.compared`, plain at rest, with ``articulated_`` as means over the
        states, in which the later states' ``giou`` counts twice.
    """
    matching = matched(true, predicted)
    rest = compared(matching)
    states = per_state(matching, np.random.default_rng(seed))
    mean = {}
    for name in rest:
        values = [state[name] for state in states]
        if name.startswith("giou"):
            values += values[1:]
        mean[f"articulated_{name}"] = float(np.mean(values))
    return Score({**rest, **mean})


def per_state(matching: Matching, rng: np.random.Generator) -> list[dict[str, float]]:
    """Return the metrics in each of ``STATES``."""
    states = []
    for share in STATES:
        scores = compared(matching, share)
        if share > 0.0:
            there, back = solid_giou(matching, share, rng)
            scores["giou"] = matching.scored(there, back, PENALTIES["giou"])
            scores["giou_matched"] = matching.scored(there, back, None)
        states.append(scores)
    return states


def solid_giou(
    matching: Matching, share: float, rng: np.random.Generator
) -> tuple[FloatArray, FloatArray]:
    """Return each pair's, seen from the predicted part and from the true one."""
    clouds = (matching.predicted, matching.true)
    ours, theirs = ([box_of(part) for part in each.parts(each.points)] for each in clouds)
    moved, truly = (each.poses(share, as_released=True)[each.present] for each in clouds)
    there = matching.each(lambda i, j: _overlap(ours[i], theirs[j], moved[i], truly[j], rng))
    back = matching.each(lambda i, j: _overlap(theirs[j], ours[i], moved[i], truly[j], rng))
    return there, back


def _overlap(
    a: FloatArray, b: FloatArray, pose_a: FloatArray, pose_b: FloatArray, rng: np.random.Generator
) -> float:
    if np.array_equal(pose_a, np.eye(4)) and np.array_equal(pose_b, np.eye(4)):
        return giou(a, b)
    inside_b = _share_inside(a, b, np.linalg.inv(pose_b) @ pose_a, rng)
    inside_a = _share_inside(b, a, np.linalg.inv(pose_a) @ pose_b, rng)
    return giou(a, b, (inside_b * volume(a) + inside_a * volume(b)) / 2.0)


def _share_inside(
    box: FloatArray, other: FloatArray, pose: FloatArray, rng: np.random.Generator
) -> float:
    """Return the share of one box that lies, moved, in another."""
    points = rng.uniform(box[0], box[1], size=(SAMPLES, 3)) @ pose[:3, :3].T + pose[:3, 3]
    return float(((points >= other[0]) & (points <= other[1])).all(axis=1).mean())
