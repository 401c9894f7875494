"""Which predicted part stands for which true one, by the area that they share."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from asset_factory.factory.mesh import FloatArray, IntArray, read_only

from .bodies import Bodies


@dataclass(frozen=True)
class Pairing:
    """The assignment of bodies that maximises the sum of intersections over unions.

    Attributes:
        shared: area in both a true and a predicted body [m2], shape [true_count, predicted_count].
        true_area, predicted_area: of each body [m2].
        pairs: rows of (true, predicted) body that share something, ascending, shape [n, 2].
    """

    shared: FloatArray
    true_area: FloatArray
    predicted_area: FloatArray
    pairs: IntArray

    def __post_init__(self) -> None:
        for name in ("shared", "true_area", "predicted_area"):
            object.__setattr__(self, name, read_only(getattr(self, name)))
        object.__setattr__(self, "pairs", read_only(self.pairs, np.int64))

    def iou(self) -> FloatArray:
        """Return the intersection over union of each pair, shape [pair_count]."""
        true, predicted = self.pairs.T
        return np.asarray(_iou(self.shared, self.true_area, self.predicted_area)[true, predicted])

    def spread(self, values: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return a value per true and per predicted body for one per pair; 0 for the unmatched."""
        of_true = np.zeros(len(self.true_area))
        of_predicted = np.zeros(len(self.predicted_area))
        of_true[self.pairs[:, 0]] = values
        of_predicted[self.pairs[:, 1]] = values
        return of_true, of_predicted


def paired(true: Bodies, predicted: Bodies, areas: FloatArray) -> Pairing:
    """Match two labellings of the same faces, whose ``areas`` [m2] have shape [face_count]."""
    from scipy.optimize import linear_sum_assignment

    shared = shared_areas(true, predicted, areas)
    true_area = shared.sum(axis=1)
    predicted_area = shared.sum(axis=0)
    rows, columns = linear_sum_assignment(-_iou(shared, true_area, predicted_area))
    pairs = np.stack([rows, columns], axis=1)
    return Pairing(shared, true_area, predicted_area, pairs[shared[rows, columns] > 0.0])


def shared_areas(true: Bodies, predicted: Bodies, areas: FloatArray) -> FloatArray:
    """Return the area of faces in both of two bodies [m2], shape [true_count, predicted_count]."""
    shape = (len(true), len(predicted))
    cells = true.labels * shape[1] + predicted.labels
    shared = np.bincount(cells, weights=areas, minlength=shape[0] * shape[1])
    return np.asarray(shared.reshape(shape), dtype=np.float64)


def _iou(shared: FloatArray, true_area: FloatArray, predicted_area: FloatArray) -> FloatArray:
    union = true_area[:, None] + predicted_area[None, :] - shared
    return np.divide(shared, union, out=np.zeros_like(shared), where=union > 0.0)
