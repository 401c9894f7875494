"""Plates that stick out of a silhouette: panels that stand open, seen along their hinges."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from ...mesh import BoolArray, FloatArray, IntArray
from ...views.raster import Raster, Side
from ...views.view import View

#: A plate is at least so long beside the longer extent, and at most so thick beside its length.
LONG = 0.2
SLIM = 0.45
#: It reaches along its hinge by this share of its length: a rail is no plate.
WIDE = 0.35
#: What stands so near a plate belongs to it, as a handle does; share of the longer extent.
BESIDE = 0.04
#: Ends of a plate by which its own thickness is told: shelves and handles stand back from them.
ENDS = 0.08
#: Pixels around a body that still are its own.
RIM = 2.0


@dataclass(frozen=True, eq=False)
class Plate:
    """A straight arm of a silhouette, in the frame of its side: right, up [m].

    Attributes:
        root: middle of its end at the body, shape [2].
        along: unit direction from there, shape [2].
        length: [m].
        whole: how far it reaches to both sides of its middle line with all that is on it, to the
            left of ``along`` [m], shape [2].
        leaf: likewise, without.
        span: from where to where it reaches away from the viewer [m], shape [2].
    """

    root: FloatArray
    along: FloatArray
    length: float
    whole: FloatArray
    leaf: FloatArray
    span: FloatArray

    @property
    def across(self) -> FloatArray:
        """Return the unit direction to the left of ``along``, shape [2]."""
        return np.array([-self.along[1], self.along[0]])

    def inner(self, toward: FloatArray) -> FloatArray:
        """Return where its side that lies in a direction begins, shape [2]."""
        off = self.leaf[1] if self.across @ toward > 0.0 else self.leaf[0]
        return np.asarray(self.root + off * self.across)


@dataclass(frozen=True, eq=False)
class Silhouette:
    """A body and the plates that stick out of it, in the frame of a side: right, up [m].

    Attributes:
        side: from which they are seen.
        low, high: corners of the body's box, shape [2].
        longest: the longer extent of all [m].
        plates: that stick out.
    """

    side: Side
    low: FloatArray
    high: FloatArray
    longest: float
    plates: tuple[Plate, ...]


def sticking_out(view: View, thin: float) -> Silhouette | None:
    """Return the body in a view and the plates that stick out of it; ``None``: all is thin.

    ``thin``: radius of a disk that fits in the body and in no neck between it and a plate, as a
    share of the longer extent.
    """
    if not view.seen.any():
        return None
    # A row of nothing around all, so that disks at the border are whole.
    solid = np.pad(ndimage.binary_fill_holes(view.seen), 1)
    longest = max(float(np.ptp(each)) for each in np.nonzero(solid))
    radius = max(thin * longest, RIM)
    core = ndimage.distance_transform_edt(solid) > radius
    thick, count = ndimage.label(ndimage.distance_transform_edt(~core) <= radius)
    if not count:
        return None
    body = thick == 1 + int(np.argmax(np.bincount(thick.ravel())[1:]))
    distance = np.asarray(ndimage.distance_transform_edt(~body))
    arms = ndimage.label(solid & (distance > RIM), np.ones((3, 3)))[0].astype(np.int64)
    pixel = view.raster.pixel
    places = _places(view.raster, body)
    return Silhouette(
        view.side,
        places.min(axis=0) - pixel / 2.0,
        places.max(axis=0) + pixel / 2.0,
        longest * pixel,
        tuple(_plates(view, arms, distance * pixel, longest * pixel)),
    )


def _places(raster: Raster, pixels: BoolArray) -> FloatArray:
    """Return where the chosen ones of padded pixels lie: right and up [m], shape [n, 2]."""
    return np.asarray(raster.low + (np.argwhere(pixels)[:, ::-1] - 1) * raster.pixel)


def _plates(view: View, arms: IntArray, distance: FloatArray, longest: float) -> Iterator[Plate]:
    """Yield the arms that are plates; ``arms`` are numbered pixels, ``distance`` is to the body."""
    raster = view.raster
    middles = view.mesh.vertices[view.mesh.faces].mean(axis=1)
    row, column = raster.nearest(middles @ view.side.frame.T)
    for number in range(1, int(arms.max()) + 1):
        arm = arms == number
        if arm.sum() * raster.pixel < LONG * longest:
            continue
        # Corners of the body stick out of it as well: only the far half tells what a plate is.
        far = arm & (distance > distance[arm].max() / 2.0)
        faces = view.mesh.faces[far[row + 1, column + 1]]
        if not len(faces):
            continue
        beside = ndimage.distance_transform_edt(~arm) * raster.pixel <= BESIDE * longest
        depths = view.mesh.vertices[faces].reshape(-1, 3) @ view.side.frame[2]
        plate = _fitted(
            _places(raster, arm),
            distance[arm],
            _places(raster, beside & (arms > 0)),
            np.percentile(depths, [0.5, 99.5]),
            raster.pixel,
        )
        thick, wide = np.ptp([plate.leaf, plate.span], axis=1) / plate.length
        if plate.length >= LONG * longest and thick <= SLIM and wide >= WIDE:
            yield plate


def _fitted(
    points: FloatArray, distance: FloatArray, beside: FloatArray, span: FloatArray, pixel: float
) -> Plate:
    """Return the plate through the points of an arm, ``distance`` from the body [m]."""
    middle = points.mean(axis=0)
    along = np.linalg.svd(points - middle, full_matrices=False)[2][0]
    # The middle of each step along it: handles and shelves would turn the longest direction.
    left = np.array([-along[1], along[0]])
    steps = np.floor((points - middle) @ along / (2.0 * pixel)).astype(np.int64)
    each = np.unique(steps)
    offs = ndimage.median((points - middle) @ left, steps, each)
    places = (each + 0.5) * 2.0 * pixel
    # Theil and Sen's line; loading scipy.stats for it would take a second.
    rises, runs = (np.subtract.outer(values, values) for values in (offs, places))
    slope = np.median(rises[runs > 0.0] / runs[runs > 0.0])
    off = np.median(offs) - slope * np.median(places)
    middle = middle + off * left
    along = (along + slope * left) / np.hypot(1.0, slope)
    length = (points - middle) @ along
    if np.corrcoef(length, distance)[0, 1] < 0.0:
        along = -along
        length = -length
    left = np.array([-along[1], along[0]])
    across = (points - middle) @ left
    whole = (beside - middle) @ left
    return Plate(
        middle + length.min() * along,
        along,
        float(np.ptp(length)),
        np.array([whole.min() - pixel, whole.max() + pixel]),
        _leaf(across, (length - length.min()) / np.ptp(length)),
        span,
    )


def _leaf(across: FloatArray, share: FloatArray) -> FloatArray:
    """Return from where to where a plate reaches at both its ends, shape [2].

    Args:
        across: of its points [m], shape [n].
        share: of its length, likewise.
    """
    ends = [np.percentile(across[each], [5.0, 95.0]) for each in (share < ENDS, share > 1.0 - ENDS)]
    both = np.array([np.max(ends, axis=0)[0], np.min(ends, axis=0)[1]])
    return both if both[0] < both[1] else np.percentile(across, [5.0, 95.0])
