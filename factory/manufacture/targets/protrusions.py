"""What sticks out of a part's front: handles and knobs, by their shape alone."""

from __future__ import annotations

import numpy as np
from scipy import ndimage

from ...geometry.edges import label_linked
from ...geometry.rows import distinct_rows
from ...mesh import FloatArray, IntArray
from ..decompose.solids import component_labels
from .shape import Moving, PartShape, rectangle

#: Faces within this angle of the panel's normal look outwards.
LOOKS_OUT = float(np.cos(np.radians(30.0)))
#: The panel is the frontmost level on which this share of the part's outline lies.
PANEL_SHARE = 0.25
#: Levels this share of the part's size apart are one, within these bounds [m].
LEVEL_SHARE = 0.02
LEVEL_BOUNDS_M = (0.003, 0.012)
#: What covers more than this share of the outline is a frame or another panel, no handle.
HANDLE_SHARE = 0.3
#: Pieces closer than this belong to one handle [m].
TOUCH_M = 0.004


def opening_direction(moving: Moving) -> FloatArray:
    """Return the normal of the part's front: the most common face direction ahead of it, [3]."""
    shape = moving.shape
    forward = moving.pull(shape.center)
    if not moving.joint.turns:
        return forward
    # Sheets may face either way.
    normals = shape.normals * np.where(shape.normals @ forward < 0.0, -1.0, 1.0)[:, None]
    ahead = normals @ forward > np.cos(np.radians(45.0))
    if not ahead.any():
        return forward
    keys = np.round(normals[ahead] * 4.0)
    first, which = distinct_rows(keys)
    commonest = keys[first[np.bincount(which, shape.areas[ahead]).argmax()]]
    commonest = commonest / np.linalg.norm(commonest)
    alike = ahead & (normals @ commonest > LOOKS_OUT)
    mean = shape.areas[alike] @ normals[alike]
    return np.asarray(mean / np.linalg.norm(mean))


def protrusions(moving: Moving, outward: FloatArray) -> list[IntArray]:
    """Find everything that sticks out of the side that looks in a direction: faces of the shape.

    The best handle first: it stands out furthest at the best place to pull.
    """
    shape = moving.shape
    height = shape.corners @ outward
    level, tolerance = _panel(shape, outward, height)
    standing = height.mean(axis=1) > level + tolerance
    label = component_labels(shape.welded)
    numbers = np.arange(label.max() + 1)
    lowest = ndimage.minimum(height.min(axis=1), label, numbers)
    highest = ndimage.maximum(height.max(axis=1), label, numbers)
    # A component of its own that starts at the panel is a handle down to its foot.
    on_top = (lowest > level - tolerance) & (highest > level + 2.0 * tolerance)
    candidates = np.flatnonzero(standing | on_top[label])
    if not len(candidates):
        return []
    whole = _outline(shape, outward)
    rated = []
    for group in _groups(shape, candidates):
        corners = shape.corners[group].reshape(-1, 3)
        reach = float(height[group].max()) - level
        covered = _outline(shape.only(group), outward) / whole
        if reach >= tolerance and covered <= HANDLE_SHARE:
            rated.append((reach * float(moving.place(corners.mean(axis=0))), group))
    return [group for _, group in sorted(rated, key=lambda pair: -pair[0])]


def _outline(shape: PartShape, outward: FloatArray) -> float:
    """Return the area of the least rectangle around the part, seen along ``outward`` [m2]."""
    sides = rectangle(shape.corners, outward)
    return float(np.prod([np.ptp(shape.corners @ side) for side in sides]))


def _panel(shape: PartShape, outward: FloatArray, height: FloatArray) -> tuple[float, float]:
    """Return the level of the front along ``outward`` [m], and how far from it is still it [m]."""
    size = float(np.ptp(shape.corners.reshape(-1, 3), axis=0).max())
    tolerance = float(np.clip(LEVEL_SHARE * size, *LEVEL_BOUNDS_M))
    # Sheets may face either way.
    flat = np.abs(shape.normals @ outward) > LOOKS_OUT
    if not flat.any():
        return float(height.max()), tolerance
    levels = height[flat].mean(axis=1)
    areas = shape.areas[flat] * np.abs(shape.normals[flat] @ outward)
    order = np.argsort(-levels, kind="stable")
    levels = levels[order]
    areas = np.concatenate([[0.0], np.cumsum(areas[order])])
    ends = np.searchsorted(-levels, -levels + tolerance, side="right")
    band = areas[ends] - areas[:-1]
    enough = np.flatnonzero(band >= PANEL_SHARE * _outline(shape, outward))
    first = int(enough[0]) if len(enough) else int(band.argmax())
    # The band starts at its frontmost face, which may be a crumb: its mean is where the panel is.
    inside = slice(first, int(ends[first]))
    return float(np.average(levels[inside], weights=np.diff(areas)[inside])), tolerance


def _groups(shape: PartShape, candidates: IntArray) -> list[IntArray]:
    """Group the candidates by component, components whose boxes touch taken together."""
    label = component_labels(shape.welded[candidates])
    count = int(label.max()) + 1
    low = np.full((count, 3), np.inf)
    high = np.full((count, 3), -np.inf)
    np.minimum.at(low, label, shape.corners[candidates].min(axis=1) - TOUCH_M / 2.0)
    np.maximum.at(high, label, shape.corners[candidates].max(axis=1) + TOUCH_M / 2.0)
    touching = (low[:, None] <= high[None]).all(axis=2) & (high[:, None] >= low[None]).all(axis=2)
    merged = label_linked(count, np.argwhere(touching))[label]
    return [candidates[merged == value] for value in np.unique(merged)]
