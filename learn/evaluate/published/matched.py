"""Parts matched by their centroids, and penalties for parts without a partner."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from asset_factory.factory.mesh import FloatArray, IntArray

from .cloud import ScoredCloud


@dataclass(frozen=True)
class Matching:
    """Two clouds, and rows of (predicted, true) positions in their ``present`` lists."""

    true: ScoredCloud
    predicted: ScoredCloud
    pairs: IntArray

    def scored(self, values: FloatArray, back: FloatArray, penalty: float | None) -> float:
        """Return the mean over predicted and mean over true parts, averaged.

        ``values`` and ``back`` are of each pair, seen from the predicted and from the true part;
        ``penalty`` is of a part without partner, ``None`` leaves such parts out.
        """
        if penalty is None:
            return float(values.mean() + back.mean()) / 2.0
        ours = len(self.predicted.present)
        theirs = len(self.true.present)
        of_predicted = (values.sum() + penalty * (ours - len(values))) / ours
        of_true = (back.sum() + penalty * (theirs - len(back))) / theirs
        return float(of_predicted + of_true) / 2.0

    def each(self, ask: Callable[[int, int], float]) -> FloatArray:
        """Return a number for each pair of (predicted, true), shape [pair_count]."""
        return np.array([ask(int(predicted), int(true)) for predicted, true in self.pairs])


def matched(true: ScoredCloud, predicted: ScoredCloud) -> Matching:
    """Return the assignment with the least sum of distances of parts' centroids, at rest."""
    from scipy.optimize import linear_sum_assignment
    from scipy.spatial.distance import cdist

    pairs = linear_sum_assignment(cdist(_centres(predicted), _centres(true)))
    return Matching(true, predicted, np.stack(pairs, axis=1))


def _centres(cloud: ScoredCloud) -> FloatArray:
    return np.stack([part.mean(axis=0) for part in cloud.parts(cloud.points)])


def chamfer(a: FloatArray, b: FloatArray) -> float:
    """Return the mean squared distance to the other cloud's nearest point, both ways, added."""
    from scipy.spatial import cKDTree

    there = cKDTree(b).query(a)[0]
    back = cKDTree(a).query(b)[0]
    return float(np.mean(there**2) + np.mean(back**2))


def half_diagonal(cloud: ScoredCloud) -> float:
    """Return half the diagonal at rest: how far a part without partner counts as off."""
    return float(np.linalg.norm(np.ptp(cloud.points, axis=0))) / 2.0
