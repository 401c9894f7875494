"""Boxes along the axes, and how far two of them agree."""

from __future__ import annotations

import numpy as np

from asset_factory.factory.mesh import FloatArray


def box_of(points: FloatArray) -> FloatArray:
    """Lower and upper corner, shape [2, 3]."""
    return np.stack([points.min(axis=0), points.max(axis=0)])


def volume(box: FloatArray) -> float:
    """Return the volume of a box; 0 if it is inside out."""
    return float(np.prod(np.maximum(box[1] - box[0], 0.0)))


def intersection(a: FloatArray, b: FloatArray) -> float:
    """Return the volume that two boxes share."""
    return volume(np.stack([np.maximum(a[0], b[0]), np.minimum(a[1], b[1])]))


def iou(a: FloatArray, b: FloatArray) -> float:
    """Return the intersection over union; 0 where both are flat."""
    shared = intersection(a, b)
    union = volume(a) + volume(b) - shared
    return shared / union if union > 0.0 else 0.0


def giou(a: FloatArray, b: FloatArray, shared: float | None = None) -> float:
    """Return the generalised intersection over union (Rezatofighi et al. 2019), -1 to 1.

    That is the share that is ``shared``, by default the intersection, less the share of the
    smallest box around both that the union leaves empty.
    """
    shared = intersection(a, b) if shared is None else shared
    union = volume(a) + volume(b) - shared
    hull = volume(np.stack([np.minimum(a[0], b[0]), np.maximum(a[1], b[1])]))
    share = shared / union if union > 0.0 else 0.0
    return share - ((hull - union) / hull if hull > 0.0 else 0.0)
