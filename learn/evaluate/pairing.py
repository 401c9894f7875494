"""Which predicted part stands for which true one, by the area that they share."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from asset_factory.factory.mesh import FloatArray, IntArray, read_only

from ..bodies import Bodies


@dataclass(frozen=True)
class Pairing:
    """The assignment of bodies that maximises the sum of intersections over unions.

    Attributes:
        true, predicted: two labellings of the same faces.
        shared: area in both a true and a predicted body [m2], shape [true_count, predicted_count].
        pairs: rows of (true, predicted) body that share something, ascending, shape [n, 2].
        iou: intersection over union of each pair, shape [n].
    """

    true: Bodies
    predicted: Bodies
    shared: FloatArray
    pairs: IntArray
    iou: FloatArray

    def __post_init__(self) -> None:
        for name, kind in (("shared", np.float64), ("pairs", np.int64), ("iou", np.float64)):
            object.__setattr__(self, name, read_only(getattr(self, name), kind))

    @property
    def size(self) -> float:
        """Return the longest side of the object [m]."""
        return float(self.true.articulation.mesh.extents.max())

    def spread(self, values: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return a value per true and per predicted body for one per pair; 0 for the unmatched."""
        of_true, of_predicted = (np.zeros(count) for count in self.shared.shape)
        of_true[self.pairs[:, 0]] = values
        of_predicted[self.pairs[:, 1]] = values
        return of_true, of_predicted


def paired(true: Bodies, predicted: Bodies, areas: FloatArray) -> Pairing:
    """Match two labellings of the same faces, whose ``areas`` [m2] have shape [face_count]."""
    from scipy.optimize import linear_sum_assignment

    shared = shared_areas(true, predicted, areas)
    union = shared.sum(axis=1)[:, None] + shared.sum(axis=0)[None, :] - shared
    iou = np.divide(shared, union, out=np.zeros_like(shared), where=union > 0.0)
    rows, columns = linear_sum_assignment(-iou)
    some = shared[rows, columns] > 0.0
    pairs = np.stack([rows, columns], axis=1)[some]
    return Pairing(true, predicted, shared, pairs, iou[rows, columns][some])


def shared_areas(true: Bodies, predicted: Bodies, areas: FloatArray) -> FloatArray:
    """Return the area of faces in both of two bodies [m2], shape [true_count, predicted_count]."""
    shape = (len(true), len(predicted))
    cells = true.labels * shape[1] + predicted.labels
    shared = np.bincount(cells, weights=areas, minlength=shape[0] * shape[1])
    return np.asarray(shared.reshape(shape), dtype=np.float64)
