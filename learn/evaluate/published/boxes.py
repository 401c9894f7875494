"""Boxes along the axes, and how far two of them agree."""

import numpy as np

from asset_factory.factory.mesh import FloatArray


def box_of(points: FloatArray) -> FloatArray:
    """Lower and upper corner, shape [2, 3]."""
    return np.stack([points.min(axis=0), points.max(axis=0)])


def volume(box: FloatArray) -> float:
    """Return the volume of a box; 0 if it is inside out."""
    return float(np.prod(np.maximum(box[1] - box[0], 0.0)))


def iou(a: FloatArray, b: FloatArray) -> float:
    """Return the intersection over union; 0 where both are flat."""
    shared = volume(np.stack([np.maximum(a[0], b[0]), np.minimum(a[1], b[1])]))
    union = volume(a) + volume(b) - shared
    return shared / union if union > 0.0 else 0.0


def enclosing(a: FloatArray, b: FloatArray) -> float:
    """Return the volume of the smallest box around both."""
    return volume(np.stack([np.minimum(a[0], b[0]), np.maximum(a[1], b[1])]))


def giou(a: FloatArray, b: FloatArray) -> float:
    """Return the generalised intersection over union (Rezatofighi et al. 2019), -1 to 1."""
    shared = volume(np.stack([np.maximum(a[0], b[0]), np.minimum(a[1], b[1])]))
    return generalised(shared, volume(a) + volume(b) - shared, enclosing(a, b))


def generalised(shared: float, union: float, hull: float) -> float:
    """Return the intersection over union less the share of the hull that the union leaves empty."""
    share = shared / union if union > 0.0 else 0.0
    return share - ((hull - union) / hull if hull > 0.0 else 0.0)
